# cmake -D BUILD=... -D SOURCE=... -D WORK=... -P install_and_use.cmake
# Installs mien below WORK, builds the consumer against that copy alone and runs it.
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix --component library)
file(GLOB_RECURSE headers RELATIVE ${WORK}/prefix ${WORK}/prefix/include/*)
foreach(header IN LISTS headers)
  if(header MATCHES "/detail/")
    message(FATAL_ERROR "a private header was installed: ${header}")
  endif()
endforeach()
run(${CMAKE_COMMAND} -G Ninja -S ${SOURCE} -B ${WORK}/build -D CMAKE_PREFIX_PATH=${WORK}/prefix
  -D CMAKE_BUILD_TYPE=${TYPE} "-D CMAKE_CXX_FLAGS=${FLAGS}")
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/consumer ${WORK}/face.glb)
run(${WORK}/build/one_room)
