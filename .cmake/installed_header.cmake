# Writes OUTPUT, the header INPUT as strangers see it: its includes begin with alpenglow/.
file(READ "${INPUT}" text)
string(REGEX REPLACE "#include \"(atmosphere|lut|renderer)/" "#include \"alpenglow/\\1/" text "${text}")
file(WRITE "${OUTPUT}" "${text}")
