// SPDX-License-Identifier: GPL-3.0-or-later
// Values as bytes and back, bit for bit, for checkpoints: of this machine's byte order, since they are read
// by the same program. A reader takes any bytes: counts are bounded by what is left, and after the first
// mistake everything reads as empty and sound() is false.
//
// A type of one's own is given as a function template over the archive, the same for both ways:
//   template <class Archive> void pass(Archive& archive, Strut& s) { archive(s.a, s.b, s.is_skin); }
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace skinframe {

class ByteWriter {
 public:
  static constexpr bool kReads = false;
  template <class... Values>
  void operator()(Values&... values) {
    (one(values), ...);
  }
  std::string take() { return std::move(bytes_); }

 private:
  template <class T>
  void plain(const T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class T>
  void one(T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      plain(value);
    } else {
      pass(*this, value);
    }
  }
  void one(std::string& text) {
    plain(static_cast<std::uint64_t>(text.size()));
    bytes_ += text;
  }
  template <int N>
  void one(Eigen::Matrix<double, N, 1>& vector) {
    static_assert(N > 0);
    for (int i = 0; i < N; ++i) plain(vector[i]);
  }
  template <class T, std::size_t N>
  void one(std::array<T, N>& values) {
    for (T& value : values) one(value);
  }
  void one(std::vector<bool>& values) {
    plain(static_cast<std::uint64_t>(values.size()));
    for (const bool value : values) plain(value);
  }
  template <class T>
  void one(std::vector<T>& values) {
    plain(static_cast<std::uint64_t>(values.size()));
    for (T& value : values) one(value);
  }
  template <class T>
  void one(std::optional<T>& value) {
    plain(value.has_value());
    if (value) one(*value);
  }
  void one(std::map<std::string, double>& values) {
    plain(static_cast<std::uint64_t>(values.size()));
    for (auto& [key, value] : values) {
      std::string copy = key;
      one(copy);
      plain(value);
    }
  }

  std::string bytes_;
};

class ByteReader {
 public:
  static constexpr bool kReads = true;
  explicit ByteReader(std::string_view bytes) : left_(bytes) {}
  template <class... Values>
  void operator()(Values&... values) {
    (one(values), ...);
  }
  // All went well so far.
  bool sound() const { return sound_; }
  // And nothing is left.
  bool complete() const { return sound_ && left_.empty(); }

 private:
  template <class T>
  void plain(T& value) {
    if (left_.size() < sizeof value) sound_ = false;
    if (!sound_) return;
    std::memcpy(&value, left_.data(), sizeof value);
    left_.remove_prefix(sizeof value);
  }
  bool flag() {
    unsigned char byte = 0;
    plain(byte);
    if (byte > 1) sound_ = false;
    return sound_ && byte == 1;
  }
  // Every element takes a byte at least.
  std::size_t count() {
    std::uint64_t n = 0;
    plain(n);
    if (n > left_.size()) sound_ = false;
    return sound_ ? static_cast<std::size_t>(n) : 0;
  }
  template <class T>
  void one(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      value = flag();
    } else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      plain(value);
    } else {
      pass(*this, value);
    }
  }
  void one(std::string& text) {
    const std::size_t size = count();
    text = left_.substr(0, size);
    left_.remove_prefix(size);
  }
  template <int N>
  void one(Eigen::Matrix<double, N, 1>& vector) {
    for (int i = 0; i < N; ++i) plain(vector[i]);
  }
  template <class T, std::size_t N>
  void one(std::array<T, N>& values) {
    for (T& value : values) one(value);
  }
  void one(std::vector<bool>& values) {
    values.assign(count(), false);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = flag();
  }
  template <class T>
  void one(std::vector<T>& values) {
    values.clear();
    const std::size_t size = count();
    for (std::size_t i = 0; i < size && sound_; ++i) one(values.emplace_back());
  }
  template <class T>
  void one(std::optional<T>& value) {
    value.reset();
    if (flag()) one(value.emplace());
  }
  void one(std::map<std::string, double>& values) {
    values.clear();
    const std::size_t size = count();
    for (std::size_t i = 0; i < size && sound_; ++i) {
      std::string key;
      one(key);
      plain(values[key]);
    }
  }

  std::string_view left_;
  bool sound_ = true;
};

// FNV-1a over 64 bits, as 16 hexadecimal digits: tells inputs apart, and guards against no forger.
inline std::string fingerprint(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3ULL;
  std::string out(16, '0');
  for (int i = 15; i >= 0; --i, hash >>= 4) out[static_cast<std::size_t>(i)] = "0123456789abcdef"[hash & 15];
  return out;
}

}  // namespace skinframe
