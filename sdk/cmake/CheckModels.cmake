# Every network in MODELS is the one that PROVENANCE.md describes: a merge can bring back an older
# file without a word.
file(READ ${MODELS}/PROVENANCE.md provenance)
file(GLOB networks ${MODELS}/*.onnx ${MODELS}/*.caffemodel)
if(NOT networks)
  message(FATAL_ERROR "${MODELS}: no network")
endif()
foreach(network IN LISTS networks)
  file(SHA256 ${network} sum)
  string(FIND "${provenance}" "${sum}" place)
  if(place EQUAL -1)
    message(SEND_ERROR "${network}: PROVENANCE.md does not name its sha256, ${sum}")
  endif()
endforeach()
