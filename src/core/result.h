#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

namespace heliodon {

/// One located message. `where` is a file, `file:line`, a JSON path or empty; `message` says what was
/// expected and what was found.
struct Error {
    std::string where;
    std::string message;

    /// "where: message", or the message alone when there is no place to name.
    [[nodiscard]] std::string text() const { return where.empty() ? message : where + ": " + message; }
};

/// A value or the one error that prevented it. Exceptions do not cross the public API.
template <class T>
using Result = tl::expected<T, Error>;

[[nodiscard]] inline tl::unexpected<Error> fail(std::string where, std::string message) {
    return tl::unexpected<Error>(Error{std::move(where), std::move(message)});
}

/// What a reader noticed but could live with; the caller decides whether and where to print it.
using Warnings = std::vector<Error>;

}  // namespace heliodon
