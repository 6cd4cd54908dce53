// SPDX-License-Identifier: GPL-3.0-or-later
// Two bodies of the corpus, one that was scanned and one that was modelled.
#include <vector>

#include "tests/fixture/corpus.h"
#include "tests/worker/verify/calculix_agreement.h"

namespace skinframe::test {
namespace {

constexpr const char* kBodies[] = {"nefertiti_70k", "wingnut"};

std::vector<CalculixBody> bodies() {
  std::vector<CalculixBody> found;
  for (const char* id : kBodies)
    if (const auto entry = corpus().find(id); entry != corpus().end())
      found.push_back({id, corpus_folder() / entry->second["file"].get<std::string>()});
  return found;
}

INSTANTIATE_TEST_SUITE_P(Corpus, CalculixAgreement, testing::ValuesIn(bodies()), short_name);

TEST(CalculixCorpus, HasItsBodiesAtTheManifestsSize) {
  for (const char* id : kBodies) {
    ASSERT_EQ(corpus().count(id), 1u) << id << " is not in " << corpus_folder();
    EXPECT_EQ(corpus().at(id)["size_mm"].get<double>(), 200);
  }
}

}  // namespace
}  // namespace skinframe::test
