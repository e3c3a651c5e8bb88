// How a Lumel function says that the world was at fault: a value or an Error, never an exception.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace lumel {

enum class ErrorCode {
    usage,          // an option or a value on the command line; exit code 2
    invalid_input,  // a file that says what cannot be
    unsupported,    // a file that asks for what Lumel does not do
    io,             // reading, writing, permissions, a full disk
    out_of_memory,  // more than --max-memory allows
    cancelled,      // the caller asked to stop
};

struct Error {
    ErrorCode code = ErrorCode::invalid_input;
    std::string message;  // what is wrong
    std::string where;    // file, mesh, texel
    std::string remedy;   // what the user can do about it

    // "where: message (remedy)"
    [[nodiscard]] std::string text() const {
        std::string out = where.empty() ? message : where + ": " + message;
        return remedy.empty() ? out : out + " (" + remedy + ")";
    }
};

struct Unit {};

template <class T>
class [[nodiscard]] Result {
public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    [[nodiscard]] bool ok() const { return state_.index() == 0; }
    explicit operator bool() const { return ok(); }

    // Precondition of the value accessors: ok(). Precondition of error(): !ok().
    [[nodiscard]] T& value() & { return *std::get_if<0>(&state_); }
    [[nodiscard]] const T& value() const& { return *std::get_if<0>(&state_); }
    [[nodiscard]] T&& value() && { return std::move(*std::get_if<0>(&state_)); }
    T* operator->() { return std::get_if<0>(&state_); }
    const T* operator->() const { return std::get_if<0>(&state_); }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    [[nodiscard]] const Error& error() const& { return *std::get_if<1>(&state_); }
    [[nodiscard]] Error&& error() && { return std::move(*std::get_if<1>(&state_)); }

private:
    std::variant<T, Error> state_;
};

using Status = Result<Unit>;
inline Status success() { return Unit{}; }

}  // namespace lumel
