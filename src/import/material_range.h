#pragma once

#include <string>

#include "scene/material.h"

namespace heliodon::import {

/// Brings factors that files give outside their range into it (base colour and the shares of metal, gloss
/// and so on 0 to 1, emission from 0); returns whether any was. Refuses numbers that single precision cannot
/// hold, in the name of `where`.
bool bring_into_range(Material& material, const std::string& where);

}  // namespace heliodon::import
