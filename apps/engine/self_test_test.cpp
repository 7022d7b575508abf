// The guard of apps/engine against miscompilation. cmake/WasmTests.cmake compiles it twice: as in the engine, and, as
// `miscompiled`, with the vectorizer that is known to break it.
#include <gtest/gtest.h>

#include <string>

namespace aspic::engine {
std::string self_test();
}
namespace aspic::miscompiled {
std::string self_test();
}

namespace aspic {
namespace {

TEST(EngineSelfTest, Passes) { EXPECT_EQ(engine::self_test(), ""); }
TEST(EngineSelfTest, DetectsMiscompiledMap) { EXPECT_EQ(miscompiled::self_test(), "an affine map"); }

}  // namespace
}  // namespace aspic
