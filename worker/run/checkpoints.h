// SPDX-License-Identifier: GPL-3.0-or-later
// Where stages keep what they have finished, so that a later attempt of the same job goes on from there.
//
// A key names the work together with all that its outcome depends on: input, options, seed. What find() gives
// was kept under the same key by the same version of the program, and the stage that goes on from it ends
// with the same result, bit for bit, as if it had never been broken off. A stage reads it as a stranger's
// bytes all the same, and begins anew where they do not make sense.
#pragma once

#include <optional>
#include <string>

namespace skinframe {

class Checkpoints {
 public:
  virtual ~Checkpoints() = default;
  // From any thread. stage: the last one that is finished in it, a name of the wire.
  virtual std::optional<std::string> find(const std::string& key) = 0;
  virtual void keep(const std::string& key, const std::string& stage, std::string bytes) = 0;
  // What find() gave was used, or made no sense: told to people.
  virtual void used(const std::string& stage) = 0;
  virtual void refused(const std::string& why) = 0;
};

}  // namespace skinframe
