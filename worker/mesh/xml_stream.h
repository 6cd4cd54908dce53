// SPDX-License-Identifier: GPL-3.0-or-later
// XML that arrives in chunks, told element by element (expat). Internal to the room.
//
// Guarantees: a document type declaration is refused, so no entity is ever defined or expanded and nothing
// outside the document is asked for; nesting is bounded; the parser's own memory is bounded, whatever names,
// attributes and namespaces the document invents. Text between elements is passed over.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "worker/run/result.h"

namespace skinframe {

// An opening tag. Views are good during the call only.
class XmlElement {
 public:
  XmlElement(const char* qualified_name, const char** attributes);

  std::string_view namespace_uri() const { return uri_; }
  std::string_view name() const { return name_; }
  // An attribute without a namespace, or with the one given.
  std::optional<std::string_view> attribute(std::string_view name, std::string_view namespace_uri = {}) const;

 private:
  std::string_view uri_, name_;
  const char** attributes_;
};

class XmlListener {
 public:
  virtual ~XmlListener() = default;
  virtual void declare_prefix(std::string_view prefix, std::string_view namespace_uri) = 0;
  virtual Status begin(const XmlElement& element, std::uint64_t line) = 0;
  virtual Status end() = 0;  // of the innermost element that began
};

class XmlStream {
 public:
  // `name` of the document stands in the messages. The listener must outlive the stream.
  XmlStream(std::string name, XmlListener& listener);
  ~XmlStream();
  XmlStream(XmlStream&&) noexcept;

  Status feed(std::string_view chunk);
  Status finish();  // the document must be whole

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace skinframe
