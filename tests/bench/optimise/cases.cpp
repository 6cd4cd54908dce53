// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/optimise/cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "tests/bench/frames/body_frame.h"

namespace skinframe::bench {
namespace {

// The paper's hanging ball: 380 nodes, 1949 struts, of which 266 nodes are left in the end, all of them on
// the skin.
const BodySize kPaperSize{{380, 1949}, 266.0 / 380};

class Frames {
 public:
  explicit Frames(const std::function<void(const NamedProblem&)>& use) : use_(use) {}
  bool any() const { return any_; }

  void add(const NamedProblem& problem) {
    any_ = true;
    use_(problem);
  }

  void add_body(const std::string& name, const Result<PreparedBody>& body,
                const std::optional<BodySize>& size, bool fixed_load) {
    if (!body) return tell(name, body.error());
    const auto sampled = sample_body(*body, size);
    if (!sampled) return tell(name, sampled.error());
    const auto posed = pose_body(*body, *sampled, true);
    if (!posed) return tell(name, posed.error());
    add({name, *posed, fixed_load});
  }

 private:
  void tell(const std::string& name, const Error& error) {
    std::cerr << "bench: " << name << " is left out: " << error.message << '\n';
  }

  const std::function<void(const NamedProblem&)>& use_;
  bool any_ = false;
};

void add_corpus(const std::filesystem::path& models, Frames& frames) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(models / "good", error))
    files.push_back(entry.path());
  if (files.empty())
    std::cerr << "bench: no corpus at " << models << " (SKINFRAME_MODELS or --models names its folder)\n";
  std::sort(files.begin(), files.end());
  for (const auto& file : files) frames.add_body(file.stem(), prepare_mesh_file(file), std::nullopt, true);
}

}  // namespace

std::vector<std::string> body_names() { return {"ellipsoid", "hanging-ball", "paper", "corpus"}; }

bool for_each_frame(const FrameChoice& choice, const std::function<void(const NamedProblem&)>& use) {
  Frames frames(use);
  for (const std::string& body : choice.bodies) {
    if (body == "ellipsoid")
      for (const FrameSize& size : choice.sizes) frames.add({"ellipsoid", make_ellipsoid(size), false});
    if (body == "hanging-ball") {
      const auto ball = prepare_sample("hanging-ball");
      for (const FrameSize& size : choice.sizes) frames.add_body("ball", ball, BodySize{size}, false);
    }
    if (body == "paper") frames.add_body("paper-ball", prepare_sample("hanging-ball"), kPaperSize, true);
    if (body == "corpus") add_corpus(choice.models, frames);
  }
  return frames.any();
}

}  // namespace skinframe::bench
