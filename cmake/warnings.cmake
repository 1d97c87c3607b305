# One interface target carries what every target of the project is compiled with: include root, warnings as errors,
# sanitizers. Third-party headers come in as system headers and are exempt.
add_library(wavecrest_options INTERFACE)
target_include_directories(wavecrest_options INTERFACE ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/generated)
target_compile_options(wavecrest_options INTERFACE
  -Wall -Wextra -Wshadow -Wconversion -Werror -fno-math-errno -ffp-contract=off)
# For objects that libwavecrest and the Python module hold as well as the program. Hidden symbols are called as directly
# as in a program; what the library exports says so (include/wavecrest/export.h). An option of the compiler rather than
# CMake's property, so that programs have it too and share precompiled headers with libraries.
if(WAVECREST_SHARED)
  target_compile_options(wavecrest_options INTERFACE -fPIC -fvisibility=hidden -fvisibility-inlines-hidden)
endif()
# With it __builtin_prefetch(p, 1) asks for a line to write, as it says. Otherwise it brings a line to read, and the store
# still waits until no other core has it. All x86-64 processors take the instruction; some old ones do nothing then.
target_compile_options(wavecrest_options INTERFACE -mprfchw)
# g++ 12 reports false positives from inlined intrinsics and std::string at -O2; they would drown real findings.
target_compile_options(wavecrest_options INTERFACE
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized -Wno-restrict>)

# Its default of 128 MB makes g++ look for garbage time and again in what it will need to the end: a twelfth of the time
# of large files. Without, they take a quarter more memory, 700 MB at most.
target_compile_options(wavecrest_options INTERFACE
  $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1048576>)

# optimize_lightly(): for folders whose code waits for files and people, or tests other code. -O3 takes half as long
# again to compile them as -O1, and nobody would notice what it gains.
set(WAVECREST_LIGHT_OPTIMIZATION $<$<CONFIG:Release>:-O1>)
macro(optimize_lightly)
  add_compile_options(${WAVECREST_LIGHT_OPTIMIZATION})
endmacro()
# Files of such a folder whose speed matters. Where a library has several, add_optimized_objects compiles them as one.
function(optimize_fully)
  set_source_files_properties(${ARGN} PROPERTIES
    COMPILE_OPTIONS $<$<CONFIG:Release>:-O3> SKIP_PRECOMPILE_HEADERS ON)
endfunction()
# add_optimized_objects(NAME TARGET source...): compiles sources of the library TARGET at -O3, as the object library NAME,
# which has a unity build of its own. To be called after target_link_libraries(TARGET), whose libraries it links too.
function(add_optimized_objects name target)
  add_library(${name} OBJECT ${ARGN})
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O3>)
  get_target_property(libraries ${target} LINK_LIBRARIES)
  target_link_libraries(${name} PRIVATE ${libraries})
  target_sources(${target} PRIVATE $<TARGET_OBJECTS:${name}>)
endfunction()

if(WAVECREST_ONLY_COMPLETE_KERNELS)
  target_compile_definitions(wavecrest_options INTERFACE WAVECREST_ONLY_COMPLETE_KERNELS)
endif()
if(WAVECREST_SANITIZE)
  # Without optimisation, as the checks multiply what an optimiser has to read and the tests do less work anyway
  # (tests/effort.h), and with lines but no variables for the debugger. Lanes have other options (kernel_library.cmake).
  target_compile_options(wavecrest_options INTERFACE
    -fsanitize=${WAVECREST_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all -O0 -g1)
  target_link_options(wavecrest_options INTERFACE -fsanitize=${WAVECREST_SANITIZE})
endif()
