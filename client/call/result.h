// SPDX-License-Identifier: Apache-2.0
// What a call of the client library gives back: a value, or a Failure that says whose move it is.
#pragma once

#include <string>
#include <utility>
#include <variant>

namespace skinframe::client {

enum class FailureKind {
  kUsage,        // the request is wrong: unknown printer or option, out of range, not built in that server
  kInput,        // the mesh or problem file: missing, unreadable, empty, too large
  kUnreachable,  // no server at the address, or its queue stayed full; nothing is wrong with the request
  kNotFound,     // no such job or artifact
  kInterrupted,  // the caller's stop token
  kLocal,        // a file or program on this machine
  kInternal,     // the server or the library broke its promise
};

struct Failure {
  FailureKind kind = FailureKind::kInternal;
  std::string message;  // one sentence: what, and the remedy
};

// Either a T or a Failure. Guarantee: exactly one of them.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}            // NOLINT(google-explicit-constructor)
  Result(Failure failure) : state_(std::move(failure)) {}  // NOLINT(google-explicit-constructor)
  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }
  const T& operator*() const& { return std::get<0>(state_); }
  T& operator*() & { return std::get<0>(state_); }
  T&& operator*() && { return std::get<0>(std::move(state_)); }
  const T* operator->() const { return &std::get<0>(state_); }
  T* operator->() { return &std::get<0>(state_); }
  const Failure& failure() const { return std::get<1>(state_); }

 private:
  std::variant<T, Failure> state_;
};

using Done = Result<std::monostate>;
inline Done done() { return std::monostate{}; }

}  // namespace skinframe::client
