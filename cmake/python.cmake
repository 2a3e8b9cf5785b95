# What the tests that are in Python run with. The standard library is all they need, so Debian's own interpreter is
# taken, whatever else is installed.
find_program(CAROM_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(CAROM_PYTHON python3 REQUIRED)
