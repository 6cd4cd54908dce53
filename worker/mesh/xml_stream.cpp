// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mesh/xml_stream.h"

#include <expat.h>
#include <fmt/format.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <tuple>
#include <utility>

#include "worker/mesh/text_scanner.h"

namespace skinframe {
namespace {

constexpr char kSeparator = '\n';  // between namespace and name; expat refuses a namespace that holds it
constexpr int kDeepest = 64;
// Of expat itself: a token that does not end, and each name it has met. A model of the size of the limits
// needs some hundred kilobytes.
constexpr std::size_t kMostMemory = std::size_t{8} << 20;

// expat's memory functions are given no place to count in; the feeding thread lends one for the call.
thread_local std::size_t* memory_in_use = nullptr;

union BlockHead {
  std::size_t size;
  std::max_align_t alignment;
};

void* limited_malloc(std::size_t size) {
  if (memory_in_use == nullptr || size > kMostMemory - *memory_in_use) return nullptr;
  auto* head = static_cast<BlockHead*>(std::malloc(sizeof(BlockHead) + size));
  if (head == nullptr) return nullptr;
  head->size = size;
  *memory_in_use += size;
  return head + 1;
}

void limited_free(void* block) {
  if (block == nullptr) return;
  BlockHead* head = static_cast<BlockHead*>(block) - 1;
  if (memory_in_use != nullptr) *memory_in_use -= head->size;
  std::free(head);
}

void* limited_realloc(void* block, std::size_t size) {
  if (block == nullptr) return limited_malloc(size);
  const std::size_t before = (static_cast<BlockHead*>(block) - 1)->size;
  void* fresh = limited_malloc(size);
  if (fresh == nullptr) return nullptr;
  std::memcpy(fresh, block, before < size ? before : size);
  limited_free(block);
  return fresh;
}

class LentCounter {
 public:
  explicit LentCounter(std::size_t& counter) : before_(std::exchange(memory_in_use, &counter)) {}
  ~LentCounter() { memory_in_use = before_; }
  LentCounter(const LentCounter&) = delete;
  LentCounter& operator=(const LentCounter&) = delete;

 private:
  std::size_t* before_;
};

std::pair<std::string_view, std::string_view> split(std::string_view qualified) {
  const std::size_t place = qualified.find(kSeparator);
  if (place == std::string_view::npos) return {{}, qualified};
  return {qualified.substr(0, place), qualified.substr(place + 1)};
}

}  // namespace

XmlElement::XmlElement(const char* qualified_name, const char** attributes) : attributes_(attributes) {
  std::tie(uri_, name_) = split(qualified_name);
}

std::optional<std::string_view> XmlElement::attribute(std::string_view name,
                                                      std::string_view namespace_uri) const {
  for (const char** a = attributes_; *a != nullptr; a += 2) {
    const auto [uri, own] = split(a[0]);
    if (own == name && uri == namespace_uri) return a[1];
  }
  return std::nullopt;
}

struct XmlStream::Parser {
  std::string name;
  XmlListener& listener;
  XML_Parser expat = nullptr;
  std::size_t memory = 0;
  int depth = 0;
  Status first_error = ok_status();

  void stop(Error error) {
    if (first_error.ok()) first_error = std::move(error);
    XML_StopParser(expat, XML_FALSE);
  }
  std::uint64_t line() const { return XML_GetCurrentLineNumber(expat); }

  static Parser& of(void* user) { return *static_cast<Parser*>(user); }
  static void XMLCALL on_begin(void* user, const char* name, const char** attributes) {
    Parser& self = of(user);
    if (!self.first_error.ok()) return;  // expat may still tell what it has parsed already
    if (++self.depth > kDeepest) {
      return self.stop(invalid_input(fmt::format("{}: line {}: elements are nested more than {} deep",
                                                 self.name, self.line(), kDeepest)));
    }
    if (Status s = self.listener.begin(XmlElement(name, attributes), self.line()); !s.ok())
      self.stop({s.error().kind, fmt::format("{}: {}", self.name, s.error().message)});
  }
  static void XMLCALL on_end(void* user, const char*) {
    Parser& self = of(user);
    if (!self.first_error.ok()) return;
    --self.depth;
    if (Status s = self.listener.end(); !s.ok())
      self.stop({s.error().kind, fmt::format("{}: {}", self.name, s.error().message)});
  }
  static void XMLCALL on_namespace(void* user, const char* prefix, const char* uri) {
    of(user).listener.declare_prefix(prefix == nullptr ? "" : prefix, uri == nullptr ? "" : uri);
  }
  static void XMLCALL on_doctype(void* user, const char*, const char*, const char*, int) {
    Parser& self = of(user);
    self.stop(invalid_input(fmt::format(
        "{}: line {}: a document type declaration (DTD) is not allowed in 3MF", self.name, self.line())));
  }

  Status parse(std::string_view chunk, bool last) {
    if (!first_error.ok()) return first_error;
    if (expat == nullptr) return internal_error("the XML parser could not be made");
    const LentCounter counter(memory);
    const XML_Status status = XML_Parse(expat, chunk.data(), static_cast<int>(chunk.size()), last);
    if (!first_error.ok()) return first_error;
    if (status == XML_STATUS_OK) return ok_status();
    const XML_Error code = XML_GetErrorCode(expat);
    if (code == XML_ERROR_NO_MEMORY) {
      first_error = invalid_input(
          fmt::format("{}: line {}: a tag or the variety of names takes more than {} MiB to parse", name,
                      line(), kMostMemory >> 20));
    } else {
      first_error = invalid_input(fmt::format("{}: line {}: {} (truncated or damaged; export it again)", name,
                                              line(), XML_ErrorString(code)));
    }
    return first_error;
  }
};

XmlStream::XmlStream(std::string name, XmlListener& listener)
    : parser_(new Parser{std::move(name), listener}) {
  const LentCounter counter(parser_->memory);
  const XML_Memory_Handling_Suite memory{limited_malloc, limited_realloc, limited_free};
  const char separator[] = {kSeparator, '\0'};
  XML_Parser expat = XML_ParserCreate_MM(nullptr, &memory, separator);
  parser_->expat = expat;
  if (expat == nullptr) return;
  XML_SetUserData(expat, parser_.get());
  XML_SetElementHandler(expat, Parser::on_begin, Parser::on_end);
  XML_SetNamespaceDeclHandler(expat, Parser::on_namespace, nullptr);
  XML_SetStartDoctypeDeclHandler(expat, Parser::on_doctype);
}

XmlStream::~XmlStream() {
  if (parser_ == nullptr) return;
  const LentCounter counter(parser_->memory);
  XML_ParserFree(parser_->expat);
}

XmlStream::XmlStream(XmlStream&&) noexcept = default;

Status XmlStream::feed(std::string_view chunk) { return parser_->parse(chunk, false); }
Status XmlStream::finish() { return parser_->parse({}, true); }

}  // namespace skinframe
