# The test/<room>/*_test.cpp of a room are one gtest program <room>_test, linked with the room; each file of them is one of ctest's tests,
# <room>_<name>_test, which runs the suites that the file has.
if(NOT WAVETANK_ROS)
  enable_testing()
  find_package(GTest REQUIRED)
  set(CATKIN_TEST_RESULTS_DIR ${CMAKE_BINARY_DIR}/test_results)
endif()
get_property(rooms GLOBAL PROPERTY WAVETANK_ROOMS)
foreach(library ${rooms})
  string(REGEX REPLACE "^wavetank_" "" room ${library})
  string(REGEX REPLACE "_library$" "" room ${room})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/test/${room}/*_test.cpp)
  if(NOT sources)
    continue()
  endif()
  if(WAVETANK_ROS)
    catkin_add_executable_with_gtest(${room}_test ${sources} EXCLUDE_FROM_ALL)
    target_link_libraries(${room}_test ${library} ${GTEST_MAIN_LIBRARIES})
  else()
    add_executable(${room}_test ${sources})
    target_link_libraries(${room}_test ${library} ${GTEST_BOTH_LIBRARIES})
  endif()
  target_compile_definitions(${room}_test PRIVATE WAVETANK_SOURCE_DIRECTORY="${CMAKE_CURRENT_SOURCE_DIR}")
  # What is slow in them is the libraries'; with a sanitizer's checks in between an optimiser takes minutes a file.
  if(WAVETANK_SANITIZE)
    target_compile_options(${room}_test PRIVATE -O0)
  else()
    target_compile_options(${room}_test PRIVATE -O1)
  endif()
  # What most of a test's compilation was spent on, once for all rooms.
  if(NOT tests_with_headers)
    set(tests_with_headers ${room}_test)
    target_precompile_headers(${room}_test PRIVATE <gtest/gtest.h> <Eigen/Geometry> <algorithm> <array> <cmath> <cstdio> <fstream> <functional> <map> <memory>
      <optional> <random> <set> <string> <vector>)
  else()
    target_precompile_headers(${room}_test REUSE_FROM ${tests_with_headers})
  endif()
  if(room STREQUAL node)
    target_link_libraries(${room}_test ZLIB::ZLIB)  # which unpacks what the room has packed
  endif()
  set_target_properties(${room}_test PROPERTIES UNITY_BUILD ${WAVETANK_FILES_TOGETHER} UNITY_BUILD_BATCH_SIZE 8)
  if(WAVETANK_FILES_TOGETHER)
    target_compile_options(${room}_test PRIVATE -Wno-subobject-linkage)
  endif()
  if(WAVETANK_STANDALONE)
    set_target_properties(${room}_test PROPERTIES EXCLUDE_FROM_ALL FALSE)  # so that a plain build has them
  endif()
  if(TARGET tests)
    add_dependencies(tests ${room}_test)
  endif()
  foreach(source ${sources})
    get_filename_component(name ${source} NAME_WE)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
    file(STRINGS ${source} heads REGEX "^(TYPED_)?TEST(_F|_P)?\\(")
    string(REGEX REPLACE "(TYPED_)?TEST(_F|_P)?\\(([A-Za-z0-9]+),[^;]*" "\\3" suites "${heads}")
    list(REMOVE_DUPLICATES suites)
    if(NOT suites)
      message(FATAL_ERROR "${source} has no TEST at the beginning of a line.")
    endif()
    set(filters)
    foreach(suite ${suites})
      list(APPEND filters "${suite}.*" "*/${suite}.*" "${suite}/*")
    endforeach()
    list(JOIN filters ":" filter)
    add_test(NAME ${room}_${name} COMMAND ${room}_test "--gtest_filter=${filter}"
      --gtest_output=xml:${CATKIN_TEST_RESULTS_DIR}/${PROJECT_NAME}/gtest-${room}_${name}.xml)
  endforeach()
endforeach()

# Every kernel on some tens of particles, each access watched by oclgrind.
add_executable(every_kernel EXCLUDE_FROM_ALL test/oclgrind/every_kernel.cpp)
target_link_libraries(every_kernel wavetank_bench_library)
if(WAVETANK_STANDALONE)
  set_target_properties(every_kernel PROPERTIES EXCLUDE_FROM_ALL FALSE)
endif()
if(TARGET tests)
  add_dependencies(tests every_kernel)
endif()
add_test(NAME oclgrind_sph COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/test/oclgrind/watched_by_oclgrind.sh
  ${CMAKE_CURRENT_SOURCE_DIR}/src/sph/kernels $<TARGET_FILE:every_kernel>)

# Damaged inputs of every kind; scripts/validate fuzz takes more of them.
add_executable(fuzz EXCLUDE_FROM_ALL test/fuzz/fuzz.cpp)
target_link_libraries(fuzz wavetank_simulation ZLIB::ZLIB)
target_compile_definitions(fuzz PRIVATE WAVETANK_SOURCE_DIRECTORY="${CMAKE_CURRENT_SOURCE_DIR}")
if(WAVETANK_STANDALONE)
  set_target_properties(fuzz PROPERTIES EXCLUDE_FROM_ALL FALSE)
endif()
if(TARGET tests)
  add_dependencies(tests fuzz)
endif()
add_test(NAME fuzz COMMAND fuzz --count 200 cases numbers overrides stl dae ply motions urdf snapshots expressions)
add_test(NAME fuzz_obj COMMAND fuzz --count 40 obj)  # of which each makes assimp fill some 50 MB of buffers
add_test(NAME fuzz_restored COMMAND fuzz --count 100 restored)  # whose simulations take steps

# Longer runs, which scripts/validate starts, and what draws the picture of docs/walls.md.
foreach(program tank_at_rest step_cost packed_particles free_flows jet_on_plate channel_flow)
  add_executable(${program} EXCLUDE_FROM_ALL test/validation/${program}.cpp)
  target_link_libraries(${program} wavetank_simulation)
  target_compile_definitions(${program} PRIVATE WAVETANK_SOURCE_DIRECTORY="${CMAKE_CURRENT_SOURCE_DIR}")
  if(WAVETANK_STANDALONE)
    set_target_properties(${program} PROPERTIES EXCLUDE_FROM_ALL FALSE)
  endif()
  if(TARGET tests)
    add_dependencies(tests ${program})
  endif()
endforeach()

# How the sources are formatted, where that can be told.
find_program(WAVETANK_CLANG_FORMAT clang-format-15)
find_program(WAVETANK_BLACK black)
if(WAVETANK_CLANG_FORMAT AND WAVETANK_BLACK AND EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/.git)
  add_test(NAME style_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/scripts/style)
else()
  message(STATUS "No test of the sources' formatting: clang-format-15, black or the repository is not there.")
endif()

add_test(NAME bench_wavetank_bench_test COMMAND ${CMAKE_COMMAND} -E env WAVETANK_BENCH=$<TARGET_FILE:wavetank_bench>
  ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/test/bench/wavetank_bench_test.py -v)
add_test(NAME bench_wavetank_check_test COMMAND ${CMAKE_COMMAND} -E env WAVETANK_CHECK=$<TARGET_FILE:wavetank_check>
  ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/test/bench/wavetank_check_test.py -v)

# Of the extension for Python; where it is not built, the test says so and does nothing.
if(WAVETANK_ROS)
  add_test(NAME python_tank_test COMMAND ${CATKIN_ENV} ${CMAKE_COMMAND} -E env WAVETANK_RUN=$<TARGET_FILE:wavetank_run>
    WAVETANK_PYTHON=$<$<BOOL:${WAVETANK_PYTHON}>:ON> ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/test/python/tank_test.py -v)
  add_test(NAME python_notebooks_test COMMAND ${CATKIN_ENV} ${CMAKE_COMMAND} -E env WAVETANK_PYTHON=$<$<BOOL:${WAVETANK_PYTHON}>:ON>
    ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/test/python/notebooks_test.py -v)
endif()

# Programs as a user runs them: Python's unittest against wavetank_run and plot_probes, rostest against a live node.
if(TARGET wavetank_node)
  find_package(rostest REQUIRED)
  foreach(name wavetank_run_test reliability_test plot_probes_test picture_tools_test wave_tools_test bag_tools_test sweep_test hydrodynamics_test readme_test web_parts_test web_test pages_test package_test)
    add_test(NAME node_${name} COMMAND ${CATKIN_ENV} ${CMAKE_COMMAND} -E env WAVETANK_RUN=$<TARGET_FILE:wavetank_run>
      ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/test/node/${name}.py -v)
  endforeach()
  add_test(NAME node_ranks_test COMMAND ${CATKIN_ENV} ${CMAKE_COMMAND} -E env WAVETANK_RUN=$<TARGET_FILE:wavetank_run>
    WAVETANK_MPI=$<$<BOOL:${MPI_C_FOUND}>:ON> ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/test/node/ranks_test.py -v)
  add_test(NAME node_install_test COMMAND ${CATKIN_ENV} ${CMAKE_COMMAND} -E env WAVETANK_BUILD=${CMAKE_BINARY_DIR}
    ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/test/node/install_test.py -v)
  add_test(NAME validation_compare_motion_test COMMAND ${CATKIN_ENV} ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/test/validation/compare_motion_test.py -v)
  add_test(NAME validation_wave_kinds_test COMMAND ${CATKIN_ENV} ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/test/validation/wave_kinds_test.py -v)
  # A short soak, with a ROS master of its own; memory and steps are for scripts/validate soak.
  add_test(NAME node_soak_test COMMAND ${CATKIN_ENV} ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/test/validation/soak.py
    $<TARGET_FILE:wavetank_node> ${CMAKE_BINARY_DIR}/soak 12 --behaviour)
  file(GLOB live_tests CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/test/node/*.test)
  foreach(live_test ${live_tests})
    add_rostest(${live_test})
  endforeach()
  find_package(roslaunch REQUIRED)
  roslaunch_add_file_check(launch IGNORE_UNSET_ARGS)
endif()

# ROS's helpers start "env python3" and look up their own host's name: the interpreter that has ROS first on the path, and no network.
# Caches of compiled kernels stay out of the home folder.
# pocl has each kernel that it compiles linked by the ld that stands first on the path: where there is gold, by that, which takes two thirds of the time.
get_filename_component(python_directory "${PYTHON_EXECUTABLE}" DIRECTORY)
set(test_path "${python_directory}:$ENV{PATH}")
find_program(WAVETANK_GOLD ld.gold)
if(WAVETANK_GOLD)
  file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/linker)
  file(CREATE_LINK ${WAVETANK_GOLD} ${CMAKE_BINARY_DIR}/linker/ld SYMBOLIC)
  set(test_path "${CMAKE_BINARY_DIR}/linker:${test_path}")
endif()
get_property(all_tests DIRECTORY PROPERTY TESTS)
set_tests_properties(${all_tests} PROPERTIES TIMEOUT 600
  ENVIRONMENT "PATH=${test_path};ROS_HOSTNAME=localhost;ROS_HOME=${CMAKE_BINARY_DIR}/ros_home;XDG_CACHE_HOME=${CMAKE_BINARY_DIR}/cache")

# The longest first, so that none is left to run by itself when the others are done.
set(cost 100)
foreach(test oclgrind_sph sph_variants_test simulation_openings_test sph_tiling_test simulation_bodies_test sph_wall_motion_test sph_thin_plate_test
        node_wavetank_run_test sph_channel_flow_test sph_schemes_test sph_moving_walls_test simulation_facing_walls_test simulation_thin_bodies_test
        simulation_still_water_test sph_shepard_figures_test sph_guard_test simulation_links_test simulation_waves_test node_reliability_test)
  if(TEST ${test})
    set_tests_properties(${test} PROPERTIES COST ${cost})
  endif()
  math(EXPR cost "${cost} - 1")
endforeach()

# Two at a time, since most of a test's time is one thread's, which compiles kernels. Of the tests with a ROS master, which wait much, one runs beside
# another test; what measures times runs by itself.
set(master_tests ${all_tests})
list(FILTER master_tests INCLUDE REGEX "rostest_test_node")
if(master_tests)
  set_tests_properties(${master_tests} PROPERTIES RESOURCE_LOCK ros_master COST 90)  # they wait for one another, so they begin early
endif()
set_tests_properties(bench_wavetank_bench_test PROPERTIES RUN_SERIAL TRUE)
