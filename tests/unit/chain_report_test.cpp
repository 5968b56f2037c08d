#include "methods/chain_report.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

RenderStats pass(std::uint64_t proposed, double deposited) {
    RenderStats stats;
    stats.proposals = {{"a", proposed, 0, 0, 0, proposed, {{"blocked", proposed / 10}}, 1, deposited},
                       {"b", proposed, 0, 0, proposed, 0, {}, 2, 1 - deposited}};
    return stats;
}

TEST(ChainReport, AddsPasses) {
    RenderStats all;
    add_pass(all, pass(100, 0.2));
    add_pass(all, pass(300, 0.6));
    ASSERT_EQ(all.proposals.size(), 2u);
    const ProposalStats &a = all.proposals[0], &b = all.proposals[1];
    EXPECT_EQ(a.proposed, 400u);
    EXPECT_EQ(a.accepted, 400u);
    EXPECT_EQ(b.rejected, 400u);
    EXPECT_EQ(a.failed.at("blocked"), 40u);
    EXPECT_DOUBLE_EQ(b.seconds, 4);
    EXPECT_DOUBLE_EQ(a.deposited, 0.5) << "share of all passes, a longer one counting more";
    EXPECT_DOUBLE_EQ(b.deposited, 0.5);
}

} // namespace
} // namespace keyhole
