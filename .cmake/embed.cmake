# Writes OUTPUT, a C++ file that holds the text of INPUT as alpenglow::embedded::SYMBOL.
# The text is cut into pieces because compilers limit the length of one literal.
file(READ "${INPUT}" text)
set(body "")
set(chunk 8000)
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
file(WRITE "${OUTPUT}"
"// ${NAME}
#include <string_view>
namespace alpenglow::embedded {
extern const std::string_view ${SYMBOL};
const std::string_view ${SYMBOL} =
${body};
}
")
