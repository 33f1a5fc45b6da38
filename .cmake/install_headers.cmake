# Writes `headers` of the folder `source` into `destination` as strangers see them: their includes begin
# with alpenglow/.
foreach(header IN LISTS headers)
  file(READ "${source}/${header}" text)
  string(REGEX REPLACE "#include \"(atmosphere|lut|renderer)/" "#include \"alpenglow/\\1/" text "${text}")
  file(WRITE "${destination}/${header}" "${text}")
endforeach()
