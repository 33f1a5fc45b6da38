# Writes OUTPUT, a C++ file that holds the text of each of FILES (paths from the folder SOURCE, separated by
# semicolons) and alpenglow::FOLDER::FindEmbeddedText, which finds a text by its path. A text is cut into pieces
# because compilers limit the length of one literal.
set(chunk 8000)
set(rows "")
foreach(name IN LISTS FILES)
  file(READ "${SOURCE}/${name}" text)
  set(body "")
  string(LENGTH "${text}" length)
  set(at 0)
  while(at LESS length)
    string(SUBSTRING "${text}" ${at} ${chunk} piece)
    string(APPEND body "R\"ALPENGLOW(${piece})ALPENGLOW\"\n")
    math(EXPR at "${at} + ${chunk}")
  endwhile()
  if(body STREQUAL "")
    set(body "\"\"")
  endif()
  string(APPEND rows "    {\"${name}\",\n${body}},\n")
endforeach()
file(WRITE "${OUTPUT}"
"// Written by alpenglow_embed.
#include <string_view>
#include <utility>

namespace alpenglow::${FOLDER} {
std::string_view FindEmbeddedText(std::string_view name);
std::string_view FindEmbeddedText(std::string_view name) {
  static const std::pair<std::string_view, std::string_view> rows[] = {
${rows}  };
  for (const auto& [key, text] : rows) {
    if (key == name) return text;
  }
  return {};
}
}  // namespace alpenglow::${FOLDER}
")
