// SPDX-License-Identifier: GPL-3.0-or-later
// What a stage gives back when it could not try: the first of three kinds of error.
//
//   1. Could not try (bad input, I/O): Result<T> holds an Error that names the element and the remedy.
//   2. Tried, and it ended thus (infeasible, iteration limit): a value with a termination reason, never an
//   Error.
//   3. A bug: SKINFRAME_CHECK aborts the job's process, never the server.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <variant>

namespace skinframe {

enum class ErrorKind {
  kInvalidInput,  // the mesh, problem file or option itself: the user mends it
  kDoesNotFit,    // larger than the printer's tray
  kUnsupported,   // understood, but not built: refused by name
  kIo,            // a file could not be read or written
  kCancelled,     // the run context asked to stop
  kInternal,      // a library gave up where it should not have
};

struct Error {
  ErrorKind kind = ErrorKind::kInternal;
  std::string message;  // one sentence: element, what is wrong with it, remedy
};

// Either a T or an Error. Guarantee: exactly one of them.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}      // NOLINT(google-explicit-constructor)
  Result(Error error) : state_(std::move(error)) {}  // NOLINT(google-explicit-constructor)
  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }
  const T& value() const& { return std::get<0>(state_); }
  T& value() & { return std::get<0>(state_); }
  T&& value() && { return std::get<0>(std::move(state_)); }
  const T* operator->() const { return &std::get<0>(state_); }
  const T& operator*() const& { return std::get<0>(state_); }
  const Error& error() const { return std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
};

// The result of a stage that yields nothing but success.
using Status = Result<std::monostate>;
inline Status ok_status() { return std::monostate{}; }

inline Error invalid_input(std::string message) { return {ErrorKind::kInvalidInput, std::move(message)}; }
inline Error unsupported(std::string message) { return {ErrorKind::kUnsupported, std::move(message)}; }
inline Error io_error(std::string message) { return {ErrorKind::kIo, std::move(message)}; }
inline Error internal_error(std::string message) { return {ErrorKind::kInternal, std::move(message)}; }

}  // namespace skinframe

// Kind 3: an invariant of ours does not hold. The job's process ends; the agent reports CRASHED.
#define SKINFRAME_CHECK(condition)                                                       \
  do {                                                                                   \
    if (!(condition)) {                                                                  \
      std::fprintf(stderr, "%s:%d: check failed: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                      \
    }                                                                                    \
  } while (false)
