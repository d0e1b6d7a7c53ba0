// Nothing: CMake compiles the tests' precompiled header for a target, and a target has a source.
