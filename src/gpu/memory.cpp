#define VMA_IMPLEMENTATION
#include "gpu/memory.h"
