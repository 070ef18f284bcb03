"""Rules for the names of tests with GoogleTest: they fit a line of ctest's output and are the same in every build."""

import re

LONGEST = 100  # characters, with the folder


def faults(folder: str, listing: str) -> list[str]:
    """Returns every violation among the tests of a folder as 'name: problem'.

    @param listing  The output of the program with --gtest_list_tests.
    """
    found = []
    suite = ""
    for line in listing.splitlines():
        if not line.startswith(" "):
            suite = line.split(" ")[0]
            continue
        test, _, parameter = line.strip().partition("  # GetParam() = ")
        name = f"{folder}.{suite}{test}"
        if len(name) > LONGEST:
            found.append(f"{name}: {len(name)} characters, expected at most {LONGEST}")
        if "-byte object <" in parameter:
            found.append(f"{name}: its parameter is printed as bytes; expected a PrintTo() beside the type")
        if re.search(r"\b0x[0-9a-f]{6,}", parameter):
            found.append(f"{name}: its parameter is printed as an address; expected a std::string or a PrintTo()")
        index = re.search(r"/(\d+)$", test)
        if index and index[1] != parameter:
            found.append(f"{name}: ends with an index; expected a name, such as by printed_name of parameter_names.h")
    return found
