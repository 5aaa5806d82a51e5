# At install time of the bundle: every shared library that the program loads, but the C library's own.
# PROGRAM, LIBRARY and VULKAN_LOADER (opened at run time, so nothing links to it) are set by the caller.
set(DESTINATION "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/lib")

file(GET_RUNTIME_DEPENDENCIES
  EXECUTABLES "${PROGRAM}"
  LIBRARIES "${LIBRARY}" ${VULKAN_LOADER}
  RESOLVED_DEPENDENCIES_VAR FOUND
  UNRESOLVED_DEPENDENCIES_VAR MISSING
  PRE_EXCLUDE_REGEXES "^ld-linux" "^lib(c|m|dl|rt|pthread|resolv|util|mvec)\\.so\\.")
if(MISSING)
  message(FATAL_ERROR "bundle: not found: ${MISSING}")
endif()
list(APPEND FOUND ${VULKAN_LOADER})
foreach(FILE ${FOUND})
  get_filename_component(NAME "${FILE}" NAME)
  if(NAME MATCHES "^lib(stdc\\+\\+|gcc_s|z|X|xcb|bsd|md|wayland|ffi)")
    file(INSTALL "${FILE}" DESTINATION "${DESTINATION}/base" FOLLOW_SYMLINK_CHAIN)
  else()
    file(INSTALL "${FILE}" DESTINATION "${DESTINATION}" FOLLOW_SYMLINK_CHAIN)
  endif()
endforeach()
