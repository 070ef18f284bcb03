// Empty: compiles the precompiled header of the tests.
