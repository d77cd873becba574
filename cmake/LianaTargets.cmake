# One folder = one job = one library, and includes point left: each target sees only the headers of what it
# links, through a folder of links in the build tree, and may only link targets that were defined before it.

# liana_library(name FOLDERS a/b ... LINKS targets ... VENDOR targets ...)
#   FOLDERS  source folders (relative to the top) whose *.cpp it compiles and whose headers it publishes
#   LINKS    liana targets to its left, public
#   VENDOR   third-party targets; private unless their headers are part of the interface
#   OWN_FLAGS  its vendors add compiler flags, so it cannot share the precompiled header
function(liana_library name)
  cmake_parse_arguments(ARG "OWN_FLAGS" "" "FOLDERS;LINKS;VENDOR" ${ARGN})
  get_property(rank GLOBAL PROPERTY liana_next_rank)
  if(NOT rank)
    set(rank 1)
  endif()
  math(EXPR next "${rank} + 1")
  set_property(GLOBAL PROPERTY liana_next_rank ${next})
  foreach(link IN LISTS ARG_LINKS)
    if(NOT TARGET ${link})
      message(FATAL_ERROR "${name} (place ${rank} in the data flow) links ${link}, which is to its right or absent")
    endif()
  endforeach()

  set(view ${PROJECT_BINARY_DIR}/view/${name})
  set(sources)
  foreach(folder IN LISTS ARG_FOLDERS)
    file(GLOB_RECURSE found CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.cpp)
    list(APPEND sources ${found})
    get_filename_component(above ${view}/${folder} DIRECTORY)
    file(MAKE_DIRECTORY ${above})
    file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${folder} ${view}/${folder} SYMBOLIC)
  endforeach()

  if(sources)
    add_library(${name} STATIC ${sources})
    target_include_directories(${name} PUBLIC ${view})
    target_link_libraries(${name} PUBLIC ${ARG_LINKS} PRIVATE liana_options ${ARG_VENDOR})
    if(NOT ARG_OWN_FLAGS)
      target_precompile_headers(${name} REUSE_FROM liana_headers)
    endif()
  else()
    add_library(${name} INTERFACE)
    target_include_directories(${name} INTERFACE ${view})
    target_link_libraries(${name} INTERFACE ${ARG_LINKS})
  endif()
endfunction()

# liana_own_flags(flags file ...): compiler flags of single files, which cannot share the precompiled header then.
function(liana_own_flags flags)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS "${flags}" SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# liana_tests(folder LINKS targets ...): one GoogleTest program from tests/<folder>/*.cpp
function(liana_tests folder)
  cmake_parse_arguments(ARG "" "" "LINKS" ${ARGN})
  file(GLOB_RECURSE found CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/${folder}/*.cpp)
  if(NOT found)
    return()
  endif()
  add_executable(test_${folder} ${found})
  target_link_libraries(test_${folder} PRIVATE liana_options liana_test_support ${ARG_LINKS} GTest::gtest GTest::gtest_main)
  target_precompile_headers(test_${folder} REUSE_FROM liana_headers)
  gtest_discover_tests(test_${folder} PROPERTIES LABELS ${folder} TIMEOUT 300 DISCOVERY_TIMEOUT 60)
endfunction()
