# mien_room(NAME USES ROOM... LIBRARIES TARGET...) makes the library target mien_NAME from src/mien/NAME.
#   USES       the rooms whose headers this room may include, itself left out: the one place where arrows are drawn
#   LIBRARIES  what its .cpp files need from outside; public headers need Eigen alone
function(mien_room name)
  cmake_parse_arguments(room "" "" "USES;LIBRARIES" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/mien/${name}/*.cpp)
  if(NOT sources)
    return()
  endif()
  add_library(mien_${name} STATIC ${sources})
  add_library(mien::${name} ALIAS mien_${name})
  target_include_directories(mien_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:include>)
  target_compile_features(mien_${name} PUBLIC cxx_std_20)
  target_link_libraries(mien_${name} PUBLIC Eigen3::Eigen)
  # Eigen's alignment is part of the binary interface: held at what every x86-64 has, so that a library built for this
  # machine's vectors and a program built without them agree.
  target_compile_definitions(mien_${name} PUBLIC EIGEN_MAX_ALIGN_BYTES=16)
  if(MIEN_NATIVE)
    target_compile_options(mien_${name} PRIVATE -march=native)
  endif()
  foreach(used IN LISTS room_USES)
    if(TARGET mien_${used})
      target_link_libraries(mien_${name} PUBLIC mien_${used})
    endif()
  endforeach()
  foreach(library IN LISTS room_LIBRARIES)
    # Libraries of headers alone are used up when the room is compiled: an installed room does not ask for them.
    get_target_property(type ${library} TYPE)
    get_target_property(links ${library} INTERFACE_LINK_LIBRARIES)
    if(type STREQUAL INTERFACE_LIBRARY AND NOT links)
      set(library $<BUILD_INTERFACE:${library}>)
    endif()
    target_link_libraries(mien_${name} PRIVATE ${library})
  endforeach()
  set_property(TARGET mien_${name} PROPERTY EXPORT_NAME ${name})
  set_property(GLOBAL APPEND PROPERTY MIEN_ROOMS ${name})
  set_property(GLOBAL PROPERTY MIEN_ROOM_${name}_USES "${room_USES}")
endfunction()
