# Turns the ```cpp blocks of a Markdown page into one program: their #include lines come first, then every
# block becomes a function of its own, then main() calls them all.

/^```cpp$/ {
    blocks++
    inside = 1
    body[blocks] = sprintf("#line %d \"%s\"\n", FNR + 1, FILENAME)
    next
}
/^```$/ {
    inside = 0
    next
}
inside && /^#include/ {
    includes = includes $0 "\n"
    body[blocks] = body[blocks] "\n"
    next
}
inside { body[blocks] = body[blocks] $0 "\n" }

END {
    print "#include \"readme/surroundings.hpp\""
    print includes
    for (i = 1; i <= blocks; i++) {
        printf "static void snippet_%d() {\n%s}\n", i, body[i]
        calls = calls sprintf("    snippet_%d();\n", i)
    }
    printf "int main() {\n%s}\n", calls
}
