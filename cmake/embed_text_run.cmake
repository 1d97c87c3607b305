# Script of embed_text (embed_text.cmake): writes OUTPUT, a C++ source with FILE as a raw string literal.
file(READ ${FILE} text)
file(WRITE ${OUTPUT} "// Generated from ${FILE}.
#include \"${HEADER}\"

namespace wavecrest {
const std::string_view ${VARIABLE} = R\"embedded(${text})embedded\";
}  // namespace wavecrest
")
