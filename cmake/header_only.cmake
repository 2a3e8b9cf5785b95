# Dependencies by their headers alone, for target systems that their libraries are not installed for.
# The headers are linked into a folder of their own: /usr/include as a whole would bring along the C library of the
# machine that compiles.
set(headers_folder ${PROJECT_BINARY_DIR}/headers)

# carom_link_header(ENTRY): makes a header, or a folder of headers, of this machine visible in headers_folder.
function(carom_link_header entry)
    find_path(folder ${entry} NO_CMAKE_FIND_ROOT_PATH NO_CACHE REQUIRED)
    file(MAKE_DIRECTORY ${headers_folder})
    file(CREATE_LINK ${folder}/${entry} ${headers_folder}/${entry} SYMBOLIC)
endfunction()

# carom_header_only(PACKAGE TARGET ENTRY [DEFINITION]...): from now on find_package(PACKAGE) gives a TARGET that
# compiles with the headers in ENTRY and links nothing.
function(carom_header_only package target entry)
    carom_link_header(${entry})
    file(CONFIGURE OUTPUT ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/${package}-config.cmake @ONLY CONTENT [[
if(NOT TARGET @target@)
    add_library(@target@ INTERFACE IMPORTED)
    target_include_directories(@target@ SYSTEM INTERFACE @headers_folder@)
    target_compile_definitions(@target@ INTERFACE @ARGN@)
endif()
]])
endfunction()

carom_header_only(fmt fmt::fmt fmt FMT_HEADER_ONLY)
carom_header_only(nlohmann_json nlohmann_json::nlohmann_json nlohmann)
carom_header_only(hwy hwy::hwy hwy HWY_COMPILE_ONLY_STATIC)
carom_header_only(tomlplusplus tomlplusplus::tomlplusplus toml++ TOML_HEADER_ONLY=1)

carom_link_header(xxhash.h)
set(XXHASH_INCLUDE_DIR ${headers_folder} CACHE PATH "Folder of xxhash.h" FORCE)
