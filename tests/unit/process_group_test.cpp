// One process of several that render a picture, by itself.
#include "cli/program.h"
#include "support/program.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace keyhole {
namespace {

/// The second process of two, of which the first takes no part.
class SecondProcess : public ProcessGroup {
  public:
    explicit SecondProcess(std::string checkpoint) : checkpoint_(std::move(checkpoint)) {}
    int rank() const override { return 1; }
    int size() const override { return 2; }
    std::vector<std::vector<char>> exchange(std::vector<char> part, bool /*stop*/) override { return {part, part}; }
    bool stopped() const override { return false; }
    std::optional<std::int64_t> take_number() override { return next_++; }
    void wait_for_all() override {
        ++waited;
        EXPECT_FALSE(std::filesystem::exists(checkpoint_));
    }
    Picture collect(Picture /*part*/, const std::function<Picture(Picture, Picture)>& /*join*/) override {
        EXPECT_TRUE(std::filesystem::exists(checkpoint_)) << "it is written, so that this test sees when";
        return {};
    }

    int waited = 0;

  private:
    std::string checkpoint_;
    std::int64_t next_ = 0;
};

} // namespace

/// The first process looks for the checkpoints of others before these write any.
TEST_F(Program, OfAGroupWritesNoCheckpointBeforeAllHaveLookedForOlderOnes) {
    SecondProcess group(scratch.path("a.checkpoint.1.exr"));
    std::vector<std::string> words{"keyhole-mpi",
                                   "render",
                                   scratch.path("scene.yaml"),
                                   "-o",
                                   scratch.path("a.exr"),
                                   "--passes",
                                   "2",
                                   "--checkpoint",
                                   "0",
                                   "-q"};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    EXPECT_EQ(run_program(static_cast<int>(arguments.size()), arguments.data(), &group), kSuccess);
    EXPECT_EQ(group.waited, 1);
}

} // namespace keyhole
