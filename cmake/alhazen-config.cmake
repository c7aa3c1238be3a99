# alhazen::intersector and the program alhazen::alhazen; with the component crosscheck, alhazen::crosscheck as well, which
# needs what Alhazen itself is built with.
include(${CMAKE_CURRENT_LIST_DIR}/alhazen-targets.cmake)
if("crosscheck" IN_LIST alhazen_FIND_COMPONENTS)
  include(CMakeFindDependencyMacro)
  list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})
  find_dependency(embree)
  find_dependency(TBB)
  find_dependency(GMP)
  include(${CMAKE_CURRENT_LIST_DIR}/alhazen-crosscheck-targets.cmake)
  set(alhazen_crosscheck_FOUND TRUE)
endif()
