// Of F Prime: its basic types and strings, as far as the component uses them.
#ifndef FW_STRING_HPP
#define FW_STRING_HPP

#include <cstdint>
#include <string>

using U8 = std::uint8_t;
using U16 = std::uint16_t;
using U32 = std::uint32_t;
using I32 = std::int32_t;
using I64 = std::int64_t;
using FwIndexType = std::int16_t;
using FwSizeType = std::uint64_t;

namespace Fw {

class StringBase {
 public:
  const char* toChar() const { return text_.c_str(); }

 protected:
  explicit StringBase(const char* text) : text_(text) {}

 private:
  std::string text_;
};

class String final : public StringBase {
 public:
  String(const char* text) : StringBase(text) {}
};

}  // namespace Fw

#endif
