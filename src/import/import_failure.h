#pragma once

#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <type_traits>
#include <utility>

#include "core/result.h"

namespace heliodon::import {

/// Ends an import with the one located message its caller gets. Thrown only inside this room; `guarded`
/// turns it into a Result at the public edge.
class ImportFailure : public std::exception {
public:
    explicit ImportFailure(Error error) : error_(std::move(error)), text_(error_.text()) {}
    [[nodiscard]] const Error& error() const { return error_; }
    [[nodiscard]] const char* what() const noexcept override { return text_.c_str(); }

private:
    Error error_;
    std::string text_;
};

[[noreturn]] inline void refuse(std::string where, std::string message) {
    throw ImportFailure(Error{std::move(where), std::move(message)});
}

/// Runs `work` and returns what it returns, or the one error that ended it.
template <class Work>
[[nodiscard]] auto guarded(const std::filesystem::path& path, Work&& work) -> Result<std::invoke_result_t<Work>> {
    try {
        if constexpr (std::is_void_v<std::invoke_result_t<Work>>) {
            work();
            return {};
        } else {
            return work();
        }
    } catch (const ImportFailure& failure) {
        return tl::unexpected<Error>(failure.error());
    } catch (const std::bad_alloc&) {
        return fail(path.string(), "does not fit into memory");
    } catch (const std::exception& failure) {
        return fail(path.string(), failure.what());
    }
}

}  // namespace heliodon::import
