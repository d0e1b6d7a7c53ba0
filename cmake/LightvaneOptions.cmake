# What every target is compiled with, and the two functions that declare targets.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

option(LIGHTVANE_TESTS "Build the tests and benchmarks" ON)
set(LIGHTVANE_SANITIZE "" CACHE STRING "Sanitizers to build with, as -fsanitize= takes them")
set(LIGHTVANE_POOL "tbb" CACHE STRING "Thread pool behind core/base/tasks.h: tbb, or std (plain threads, which the thread sanitizer understands)")
set(LIGHTVANE_ARCH "auto" CACHE STRING "The least processor: v4 or v3 of x86-64, baseline, or auto: the best of them that this machine is")

if(NOT CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(LIGHTVANE_CCACHE ccache)
  if(LIGHTVANE_CCACHE)
    # Precompiled headers are compared by what is in them (ccache's manual, "Precompiled headers").
    set(CMAKE_CXX_COMPILER_LAUNCHER
        "${CMAKE_COMMAND};-E;env;CCACHE_SLOPPINESS=pch_defines,time_macros;${LIGHTVANE_CCACHE}")
  endif()
endif()

# AVX2 is worth a factor of two in the answering loops, and AVX-512 a tenth of a picture's time on top. A binary
# built for them checks the processor before anything else runs (app/cpu_guard.cpp), so that an older machine gets
# a message and no crash. LIGHTVANE_X86_64_LEVEL is 4, 3, or 1 for the baseline.
set(LIGHTVANE_X86_64_LEVEL 1)
if(LIGHTVANE_ARCH MATCHES "^v([34])$")
  set(LIGHTVANE_X86_64_LEVEL ${CMAKE_MATCH_1})
elseif(LIGHTVANE_ARCH STREQUAL "auto")
  include(CheckCXXSourceRuns)
  function(check_machine result)
    list(TRANSFORM ARGN REPLACE "(.+)" "__builtin_cpu_supports(\"\\1\")")
    list(JOIN ARGN " && " supported)
    check_cxx_source_runs("int main() { return ${supported} ? 0 : 1; }" ${result})
  endfunction()
  check_machine(LIGHTVANE_MACHINE_IS_V3 avx2 fma bmi2)
  check_machine(LIGHTVANE_MACHINE_IS_V4 avx2 fma bmi2 avx512f avx512bw avx512cd avx512dq avx512vl)
  if(LIGHTVANE_MACHINE_IS_V4)
    set(LIGHTVANE_X86_64_LEVEL 4)
  elseif(LIGHTVANE_MACHINE_IS_V3)
    set(LIGHTVANE_X86_64_LEVEL 3)
  endif()
endif()

# In unity builds, what is in no named namespace needs a name of its own in its folder.
set(CMAKE_UNITY_BUILD_BATCH_SIZE 8)

add_library(lightvane_options INTERFACE)
target_include_directories(lightvane_options INTERFACE "${CMAKE_SOURCE_DIR}")
target_compile_options(lightvane_options INTERFACE
  # Clang's -Wconversion contains -Wsign-conversion, g++'s does not.
  -Wall -Wextra -Wconversion -Wno-sign-conversion -Wshadow -Werror
  # The same expression must give the same bytes wherever it is inlined: records are computed again and compared.
  -ffp-contract=off
  -fno-math-errno -fno-trapping-math
  # GCC 12's SLP vectoriser drops the rounding of double -> float -> double, depending on what is inlined where.
  -fno-tree-slp-vectorize
  # GCC 12 warns of a copy onto itself in any `"text" + string` that it inlines (GCC bug 105651).
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>)
if(CMAKE_UNITY_BUILD)
  # Takes sources for headers where others include them.
  target_compile_options(lightvane_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()
if(LIGHTVANE_X86_64_LEVEL GREATER 1)
  target_compile_options(lightvane_options INTERFACE -march=x86-64-v${LIGHTVANE_X86_64_LEVEL})
endif()
if(LIGHTVANE_X86_64_LEVEL EQUAL 4)
  target_compile_options(lightvane_options INTERFACE -mprefer-vector-width=512)
endif()
target_compile_definitions(lightvane_options INTERFACE LIGHTVANE_X86_64_LEVEL=${LIGHTVANE_X86_64_LEVEL})
if(LIGHTVANE_SANITIZE)
  target_compile_options(lightvane_options INTERFACE
    -fsanitize=${LIGHTVANE_SANITIZE} -fno-omit-frame-pointer
    # The undefined-behaviour sanitizer would only print, and the test pass.
    -fno-sanitize-recover=all
    # The checks that sanitizers insert mislead this warning (GCC's manual, -fsanitize=address).
    -Wno-maybe-uninitialized)
  target_link_options(lightvane_options INTERFACE -fsanitize=${LIGHTVANE_SANITIZE})
endif()

# lightvane_library(name LINKS ... [PRIVATE_LINKS ...] [EXCLUDE ...]): one folder, one library, made of every .cpp in it.
# LINKS are the arrows of docs/architecture.md; tests/architecture checks the #include lines against the same table.
function(lightvane_library name)
  cmake_parse_arguments(ARG "" "" "LINKS;PRIVATE_LINKS;EXCLUDE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS *.cpp)
  foreach(excluded ${ARG_EXCLUDE})
    list(REMOVE_ITEM sources "${CMAKE_CURRENT_SOURCE_DIR}/${excluded}")
  endforeach()
  add_library(${name} STATIC ${sources})
  target_link_libraries(${name} PUBLIC lightvane_options ${ARG_LINKS} PRIVATE ${ARG_PRIVATE_LINKS})
endfunction()

# lightvane_test_options(name): how tests are compiled. Compiling them takes longer than running them: what they call is
# optimised, not they.
function(lightvane_test_options name)
  target_link_libraries(${name} PRIVATE lightvane_options GTest::gmock)
  # The same bug as above, where strings come from a precompiled header.
  target_compile_options(${name} PRIVATE
    "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-array-bounds;-Wno-stringop-overflow>")
  if(LIGHTVANE_SANITIZE)
    target_compile_options(${name} PRIVATE -O0)
  else()
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
endfunction()

# lightvane_test(name LINKS ... [PROPERTIES ...]): every .cpp of a tests folder in one GoogleTest program. PROPERTIES are
# those of its tests. Under sanitizers, where a program takes half a second to start, they run in eight parts and not
# one by one.
function(lightvane_test name)
  cmake_parse_arguments(ARG "" "" "LINKS;PROPERTIES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS *.cpp)
  add_executable(${name} ${sources})
  lightvane_test_options(${name})
  target_link_libraries(${name} PRIVATE ${ARG_LINKS} GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE LIGHTVANE_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
  target_precompile_headers(${name} REUSE_FROM lightvane_test_headers)
  # Most of the time goes to what tests include: eight at a time take a third of it.
  set_target_properties(${name} PROPERTIES UNITY_BUILD ON)
  if(LIGHTVANE_SANITIZE)
    foreach(part RANGE 7)
      add_test(NAME ${name}.${part} COMMAND ${name})
      set_tests_properties(${name}.${part} PROPERTIES
        ENVIRONMENT "GTEST_TOTAL_SHARDS=8;GTEST_SHARD_INDEX=${part}" TIMEOUT 1200 ${ARG_PROPERTIES})
    endforeach()
  else()
    gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 600 ${ARG_PROPERTIES})
  endif()
endfunction()

# lightvane_headers_alone(name HEADERS ... LINKS ...): compiles each header as the only #include of a source file, so that
# none leans on what its users happen to include first.
function(lightvane_headers_alone name)
  cmake_parse_arguments(ARG "" "" "HEADERS;LINKS" ${ARGN})
  set(sources)
  foreach(header ${ARG_HEADERS})
    cmake_path(RELATIVE_PATH header BASE_DIRECTORY "${CMAKE_SOURCE_DIR}" OUTPUT_VARIABLE included)
    set(source "${CMAKE_CURRENT_BINARY_DIR}/${name}/${included}.cpp")
    file(CONFIGURE OUTPUT "${source}" CONTENT "#include \"${included}\"\n")
    list(APPEND sources "${source}")
  endforeach()
  add_library(${name} OBJECT ${sources})
  target_link_libraries(${name} PRIVATE lightvane_options ${ARG_LINKS})
  # Only whether they compile counts: no optimisation, so that it costs little.
  target_compile_options(${name} PRIVATE -O0 -g0)
endfunction()
