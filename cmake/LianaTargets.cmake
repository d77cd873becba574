# One folder = one job = one library, and includes point left: each target sees only the headers of what it
# links, through a folder of links in the build tree, and may only link targets that were defined before it.

# liana_library(name FOLDERS a/b ... LINKS targets ... VENDOR targets ...)
#   FOLDERS  source folders (relative to the top) whose *.cpp it compiles and whose headers it publishes
#   LINKS    liana targets to its left, public
#   VENDOR   third-party targets; private unless their headers are part of the interface
#   OWN_FLAGS  its vendors add compiler flags, so it cannot share the precompiled header
#   HEADLESS  part of the simulator: neither it nor what it links may link OpenGL, windows, CGAL or TetGen;
#              installed for others
#   STRICT    -Wshadow -Wconversion, and warnings are errors. For every target that is clean; new ones are.
#   TOGETHER  compiles several files as one, so that what they all include is read once: names in their anonymous
#              namespaces must differ then. For what is not edited every day.
function(liana_library name)
  cmake_parse_arguments(ARG "OWN_FLAGS;TOGETHER;HEADLESS;STRICT" "" "FOLDERS;LINKS;VENDOR" ${ARGN})
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
    target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${view}>)
    target_link_libraries(${name} PUBLIC ${ARG_LINKS} PRIVATE liana_options ${ARG_VENDOR})
    if(NOT ARG_OWN_FLAGS)
      target_precompile_headers(${name} REUSE_FROM liana_headers)
    endif()
    if(ARG_STRICT)
      target_compile_options(${name} PRIVATE -Wshadow -Wconversion $<$<BOOL:${LIANA_WERROR}>:-Werror>)
    endif()
    if(ARG_TOGETHER)
      set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
    endif()
  else()
    add_library(${name} INTERFACE)
    target_include_directories(${name} INTERFACE $<BUILD_INTERFACE:${view}>)
    target_link_libraries(${name} INTERFACE ${ARG_LINKS})
  endif()
  if(ARG_HEADLESS)
    liana_check_headless(${name})
    liana_install_library(${name} ${ARG_FOLDERS})
  endif()
endfunction()

# The simulator for others (cmake --install BUILD --component library): liana_sim becomes liana::sim.
function(liana_install_library name)
  string(REPLACE liana_ "" short ${name})
  set_target_properties(${name} PROPERTIES EXPORT_NAME ${short})
  target_include_directories(${name} INTERFACE $<INSTALL_INTERFACE:include/liana>)
  install(TARGETS ${name} EXPORT liana ARCHIVE DESTINATION lib COMPONENT library)
  foreach(folder IN LISTS ARGN)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder}/ DESTINATION include/liana/${folder} COMPONENT library
            FILES_MATCHING PATTERN *.h)
  endforeach()
endfunction()

# liana_link_closure(target result): all that a target links, itself included, by the names that were given.
function(liana_link_closure target result)
  set(open ${target})
  set(closed)
  while(open)
    list(POP_FRONT open next)
    if(next IN_LIST closed)
      continue()
    endif()
    list(APPEND closed ${next})
    if(TARGET ${next})
      foreach(property LINK_LIBRARIES INTERFACE_LINK_LIBRARIES)
        get_target_property(links ${next} ${property})
        if(links)
          string(REGEX REPLACE "\\$<LINK_ONLY:([^>]*)>" "\\1" links "${links}")
          list(APPEND open ${links})
        endif()
      endforeach()
    endif()
  endwhile()
  set(${result} ${closed} PARENT_SCOPE)
endfunction()

function(liana_check_headless target)
  liana_link_closure(${target} closure)
  foreach(link IN LISTS closure)
    if(link MATCHES "CGAL|EPOXY|EGL|GLFW|IMGUI|GLEW|OpenGL|liana_(exact|tets|view|app)$" OR link STREQUAL TET_LIBRARY)
      message(FATAL_ERROR "${target} is part of the simulator, which runs without OpenGL, CGAL and TetGen; it links ${link}")
    endif()
  endforeach()
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
  target_precompile_headers(test_${folder} REUSE_FROM liana_test_headers)
  gtest_discover_tests(test_${folder} PROPERTIES LABELS ${folder} TIMEOUT 300 DISCOVERY_TIMEOUT 60)
endfunction()
