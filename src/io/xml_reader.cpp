// SPDX-License-Identifier: Apache-2.0
#include "io/xml_reader.h"

#include <expat.h>
#include <fmt/format.h>

#include <exception>
#include <memory>
#include <new>
#include <type_traits>

#include "io/bad_file.h"

namespace pierce::io {
namespace {

constexpr char kSeparator = ' ';

XmlName split_name(std::string_view name) {
  const std::size_t at = name.rfind(kSeparator);
  if (at == name.npos) return {{}, name};
  return {name.substr(0, at), name.substr(at + 1)};
}

// Exceptions must not pass through Expat, which is C: they wait here.
struct State {
  XML_Parser parser;
  const XmlCalls& calls;
  std::exception_ptr thrown = nullptr;

  template <class Call>
  void guarded(Call call) {
    if (thrown) return;
    try {
      call();
    } catch (...) {
      thrown = std::current_exception();
      XML_StopParser(parser, XML_FALSE);
    }
  }
};

void on_open(void* data, const XML_Char* name, const XML_Char** attributes) {
  State& state = *static_cast<State*>(data);
  state.guarded([&] {
    state.calls.open(XmlElement(name, attributes, XML_GetCurrentLineNumber(state.parser)));
  });
}

void on_close(void* data, const XML_Char* name) {
  State& state = *static_cast<State*>(data);
  state.guarded([&] { state.calls.close(split_name(name)); });
}

void on_prefix(void* data, const XML_Char* prefix, const XML_Char* space) {
  State& state = *static_cast<State*>(data);
  if (prefix == nullptr || space == nullptr) return;
  state.guarded([&] { state.calls.prefix(prefix, space); });
}

}  // namespace

XmlName XmlElement::name() const { return split_name(name_); }

std::optional<std::string_view> XmlElement::attribute(std::string_view local,
                                                      std::string_view space) const {
  for (const char* const* at = attributes_; *at != nullptr; at += 2) {
    const XmlName name = split_name(at[0]);
    if (name.local == local && name.space == space) return at[1];
  }
  return std::nullopt;
}

void read_xml(std::string_view text, const std::string& name, const XmlCalls& calls) {
  const std::unique_ptr<std::remove_pointer_t<XML_Parser>, decltype(&XML_ParserFree)> parser(
      XML_ParserCreateNS(nullptr, kSeparator), &XML_ParserFree);
  if (!parser) throw std::bad_alloc();
  State state{parser.get(), calls};
  XML_SetUserData(parser.get(), &state);
  XML_SetElementHandler(parser.get(), on_open, on_close);
  XML_SetStartNamespaceDeclHandler(parser.get(), on_prefix);
  constexpr std::size_t kPiece = std::size_t{1} << 24;  // Expat counts in int
  XML_Status status = XML_STATUS_OK;
  do {
    const std::string_view piece = text.substr(0, kPiece);
    text.remove_prefix(piece.size());
    status =
        XML_Parse(parser.get(), piece.data(), static_cast<int>(piece.size()), text.empty() ? 1 : 0);
  } while (status == XML_STATUS_OK && !text.empty());
  if (state.thrown) std::rethrow_exception(state.thrown);
  if (status != XML_STATUS_OK) {
    if (XML_GetErrorCode(parser.get()) == XML_ERROR_UNKNOWN_ENCODING)
      bad_line(name, 1, "names an encoding that is not read: save it as UTF-8");
    bad_line(name, XML_GetCurrentLineNumber(parser.get()),
             fmt::format("is not well-formed XML ({}): get the file again",
                         XML_ErrorString(XML_GetErrorCode(parser.get()))));
  }
}

}  // namespace pierce::io
