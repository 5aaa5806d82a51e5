#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace heliodon::tests {

/// A file's name and its bytes.
struct SampleFile {
    std::string name;
    std::string bytes;
};

/// A small, whole input: the files of one folder and the one to open. Together the samples use every part of
/// each format that the program reads.
struct Sample {
    std::string name;
    std::string opened;
    std::vector<SampleFile> files;
};

[[nodiscard]] std::vector<Sample> samples();

/// A picture as a file of the ending's format holds it.
[[nodiscard]] std::string picture_bytes(const std::string& ending, int width, int height);

}  // namespace heliodon::tests
