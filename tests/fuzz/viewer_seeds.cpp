// Messages of the viewer's page, and runs for the page.
#include "run_files.h"
#include "seeds.h"
#include "several_files.h"

namespace aspic::fuzz {

std::vector<Seed> viewer_seeds() {
  const std::string recording =
      R"({"scene":"a.toml","overrides":["time.step=0.01"],"compare":{"overrides":["material.young=2e5"],"label":"b"},)"
      R"("events":[{"step":1,"command":{"do":"stiffness","value":100}},{"step":2,"b":1,"command":{"do":"release"}}],"steps":3})";
  const Folder begun = begun_run(2);
  std::vector<Seed> seeds = {
      {"page_text", "recording", recording},
      {"page_text", "address", "/session?x=1&token=0123456789abcdef"},
      {"page_text", "question", R"({"ask":"scene","id":7,"side":"a"})"},
      {"session", "steps",
       "{\"do\":\"step\"}\n{\"do\":\"iterate\"}\n{\"do\":\"rewind\",\"step\":1}\n{\"do\":\"play\"}\n{\"do\":"
       "\"reset\"}"},
      {"session", "hand",
       "{\"do\":\"grab\",\"side\":\"a\",\"triangle\":3,\"weights\":[0.2,0.3,0.5],\"target\":[0.1,1.2,0.5]}\n"
       "{\"do\":\"move\",\"target\":[0,2,0]}\n{\"do\":\"step\"}\n{\"do\":\"release\"}\n{\"do\":\"stiffness\",\"value\":"
       "10}"},
      {"session", "settings",
       "{\"do\":\"set\",\"key\":\"material.young\",\"value\":2e5}\n{\"do\":\"set\",\"key\":\"solver.method\",\"value\":"
       "\"lbfgs\"}\n{\"do\":\"set\",\"key\":\"gravity\",\"value\":[0,1,0]}\n{\"do\":\"color\",\"field\":\"stretch\"}"},
      {"session", "questions",
       "{\"ask\":\"vertex\",\"id\":1,\"side\":\"a\",\"vertex\":0}\n{\"ask\":\"tet\",\"id\":2,\"side\":\"a\","
       "\"triangle\":1}\n"
       "{\"ask\":\"worst\",\"id\":3,\"side\":\"a\"}\n{\"ask\":\"mesh\",\"id\":4,\"side\":\"a\",\"format\":\"obj\"}\n"
       "{\"ask\":\"recording\",\"id\":5}\n{\"do\":\"step\"}\n{\"ask\":\"iteration\",\"id\":6,\"side\":\"a\",\"step\":1,"
       "\"iteration\":0}"},
      {"session", "compare",
       "{\"do\":\"compare\",\"overrides\":[\"material.young=2e5\"],\"label\":\"soft\"}\n{\"do\":\"step\"}\n"
       "{\"do\":\"end_compare\"}\n{\"do\":\"surface\",\"which\":\"cage\"}\n{\"do\":\"pin\",\"side\":\"a\",\"vertices\":"
       "[1,2],\"pinned\":true}"},
      {"session", "function",
       "{\"ask\":\"function\",\"id\":1,\"name\":\"x^2+y^2\",\"start\":[1,1],\"settings\":{\"method\":\"newton\"},"
       "\"iteration\":1,\"samples\":5}"},
  };
  const auto file = [&](const std::string& name) { return std::pair(name, begun.contents(name)); };
  seeds.push_back({"run_recording", "steps", joined_files({file("steps.csv"), file("iterations.csv")})});
  seeds.push_back({"run_recording", "trials", joined_files({file("trace/trials.csv")})});
  seeds.push_back({"run_recording", "frame", joined_files({file("frames/body_000001.vtu")})});
  seeds.push_back({"run_recording", "checkpoint", joined_files({file("checkpoint.bin")})});
  seeds.push_back({"run_recording", "skin", joined_files({file("skins/skin_a.pc2")})});
  return seeds;
}

}  // namespace aspic::fuzz
