// Scenes generated from a name.
#include "interflect/load.h"

#include <gtest/gtest.h>

#include <string>

#include "interflect/core.h"
#include "interflect/generate.h"
#include "tests/support/refusals.h"

namespace interflect {

using namespace detail;
namespace {

std::string fault_of(const std::string& name, const ReadOptions& options = {}) {
    try {
        load_scene(name, options);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(LoadScene, MazeIsMadeInMemory) {
    const Scene empty = load_scene("maze:12"), furnished = load_scene("maze:4:furniture");
    EXPECT_EQ(empty.patches.size(), make_maze({.rooms = 12}).patches.size());
    EXPECT_EQ(furnished.patches.size(), make_maze({.rooms = 4, .furniture = true}).patches.size());
    EXPECT_EQ(empty.views.size(), 13u);
    EXPECT_EQ(furnished.name, "maze:4:furniture");
    EXPECT_TRUE(furnished.files.empty());
}

TEST(LoadScene, MazeThatIsNotUnderstood) {
    for (const char* const name : {"maze:", "maze:0", "maze:-3", "maze:4x", "maze:4:", "maze:4:chairs",
                                   "maze::furniture", "maze:4:furniture:2", "maze:1e3", "maze:99999999999"})
        EXPECT_NE(fault_of(name).find(std::string(name) + ": expected maze:ROOMS or maze:ROOMS:furniture"),
                  std::string::npos)
            << fault_of(name);
    EXPECT_NE(fault_of("maze:10001").find("1 to 10000 rooms"), std::string::npos);
}

TEST(LoadScene, MazeBeyondTheLimitOfPatches) {
    EXPECT_NE(fault_of("maze:4:furniture", {.max_patches = 1000}).find("max_patches"), std::string::npos);
    EXPECT_EQ(testing_support::refused_setting([&] { load_scene("maze:4:furniture", {.max_patches = 1000}); }),
              "max_patches");
    EXPECT_EQ(fault_of("maze:4", {.max_patches = 1000}), "no error");
}

}  // namespace
}  // namespace interflect
