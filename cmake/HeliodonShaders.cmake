# heliodon_shaders(TARGET target NAMESPACE ns BASE folder FOLDERS folder...)
# Compiles every GLSL file below the FOLDERS of BASE to SPIR-V at build time and embeds it in TARGET. The generated header
# "<target>_shaders.h" declares `std::span<const heliodon::gpu::EmbeddedShader> <ns>::embedded_shaders()`;
# a shader's name is its path below BASE ("passes/shade/shade.comp"). #include looks below src/, BASE and
# beside the file; it needs GL_GOOGLE_include_directive, which each shader enables itself.
find_program(GLSLANG_VALIDATOR NAMES glslangValidator glslang REQUIRED)

function(heliodon_shaders)
  cmake_parse_arguments(ARG "" "TARGET;NAMESPACE;BASE" "FOLDERS" ${ARGN})
  set(PATTERNS)
  foreach(FOLDER ${ARG_FOLDERS})
    foreach(STAGE comp vert frag geom tesc tese)
      list(APPEND PATTERNS ${ARG_BASE}/${FOLDER}/*.${STAGE})
    endforeach()
  endforeach()
  file(GLOB_RECURSE FILES CONFIGURE_DEPENDS ${PATTERNS})

  set(OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${ARG_TARGET}_shaders)
  set(GENERATED)
  set(INCLUDES "")
  set(ENTRIES "")
  foreach(FILE ${FILES})
    file(RELATIVE_PATH NAME ${ARG_BASE} ${FILE})
    string(MAKE_C_IDENTIFIER ${NAME} IDENTIFIER)
    set(HEADER ${OUTPUT}/${IDENTIFIER}.inc)
    add_custom_command(
      OUTPUT ${HEADER}
      COMMAND ${GLSLANG_VALIDATOR} --quiet -V --target-env vulkan1.3 -I${PROJECT_SOURCE_DIR}/src -I${ARG_BASE}
              --depfile ${HEADER}.d --vn ${IDENTIFIER} -o ${HEADER}
              ${FILE}
      DEPENDS ${FILE}
      DEPFILE ${HEADER}.d
      COMMENT "Shader ${NAME}"
      VERBATIM)
    list(APPEND GENERATED ${HEADER})
    string(APPEND INCLUDES "#include \"${HEADER}\"\n")
    string(APPEND ENTRIES "        {\"${NAME}\", ${IDENTIFIER}},\n")
  endforeach()

  file(CONFIGURE OUTPUT ${OUTPUT}/${ARG_TARGET}_shaders.h @ONLY CONTENT [=[
#pragma once
#include <span>
#include "gpu/shader.h"
namespace @ARG_NAMESPACE@ {
[[nodiscard]] std::span<const heliodon::gpu::EmbeddedShader> embedded_shaders();
}
]=])
  list(LENGTH FILES COUNT)
  if(COUNT EQUAL 0)
    set(BODY "    return {};")
  else()
    set(BODY "    static constexpr heliodon::gpu::EmbeddedShader shaders[] = {\n${ENTRIES}    };\n    return shaders;")
  endif()
  file(CONFIGURE OUTPUT ${OUTPUT}/${ARG_TARGET}_shaders.cpp @ONLY CONTENT [[
#include "@ARG_TARGET@_shaders.h"
#include <cstdint>
namespace {
@INCLUDES@}
namespace @ARG_NAMESPACE@ {
std::span<const heliodon::gpu::EmbeddedShader> embedded_shaders() {
@BODY@
}
}
]])
  set_source_files_properties(${OUTPUT}/${ARG_TARGET}_shaders.cpp PROPERTIES OBJECT_DEPENDS "${GENERATED}")
  target_sources(${ARG_TARGET} PRIVATE ${OUTPUT}/${ARG_TARGET}_shaders.cpp)
  target_include_directories(${ARG_TARGET} PUBLIC ${OUTPUT})
endfunction()
