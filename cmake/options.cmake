# How every target of this project is compiled.

# The target is an interface of flags only; carom_target() applies it.
add_library(carom_options INTERFACE)
target_compile_features(carom_options INTERFACE cxx_std_20)
target_compile_definitions(carom_options INTERFACE CAROM_VERSION="${PROJECT_VERSION}")

# No -ffast-math and no -march=native, ever: state must have the same bits on every machine.
# errno is never read, and without it a square root is one instruction; its result is the same.
target_compile_options(carom_options INTERFACE
    -fno-math-errno
    -Wall -Wextra -Wpedantic
    -Wshadow -Wconversion -Wsign-conversion -Wdouble-promotion -Wold-style-cast -Wcast-align
    -Wnon-virtual-dtor -Woverloaded-virtual -Wformat=2 -Wundef -Wextra-semi -Wimplicit-fallthrough
    $<$<CXX_COMPILER_ID:GNU>:-Wduplicated-cond -Wduplicated-branches -Wlogical-op>
    $<$<BOOL:${CAROM_WARNINGS_AS_ERRORS}>:-Werror>)

if(CAROM_SANITIZE)
    set(sanitize -fsanitize=${CAROM_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_compile_options(carom_options INTERFACE ${sanitize})
    target_link_options(carom_options INTERFACE ${sanitize})
endif()

# Common properties of a library, program or test of this project.
function(carom_target target)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:carom_options>)
    set_target_properties(${target} PROPERTIES
        CXX_EXTENSIONS OFF
        POSITION_INDEPENDENT_CODE ON
        EXPORT_COMPILE_COMMANDS ON)
endfunction()
