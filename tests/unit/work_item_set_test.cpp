// Sets of units of work.
#include "core/work_item_set.h"

#include "core/error.h"

#include <gtest/gtest.h>

namespace keyhole {

TEST(WorkItemSet_Text, ComesBack) {
    for (const char* text : {"", "0:1", "0:3,6:9", "2:5,7:8,100:1000000000000"})
        EXPECT_EQ(WorkItemSet::parse(text).to_string(), text);
    EXPECT_EQ(WorkItemSet::parse("6:9,3:6,0:1").to_string(), "0:1,3:9");
    for (const char* text : {"1", "a:b", "3:3", "5:2", "-1:2", "0:3,2:5", "0:1;2:3", "0:99999999999999999999", "0:1x"})
        EXPECT_THROW(WorkItemSet::parse(text), InputError) << text;
}

TEST(WorkItemSet_Adding, JoinsNeighboursAndRefusesWhatItHas) {
    WorkItemSet set;
    for (const int unit : {4, 0, 2, 1}) set.add(unit);
    EXPECT_EQ(set.to_string(), "0:3,4:5");
    EXPECT_FALSE(set.add(WorkItemSet(2, 4)));
    EXPECT_EQ(set.to_string(), "0:3,4:5");
    EXPECT_TRUE(set.add(WorkItemSet(3, 4)));
    EXPECT_EQ(set.to_string(), "0:5");
    EXPECT_EQ(set.size(), 5);
}

TEST(WorkItemSet_Missing, CountsWhatIsLeftOut) {
    const WorkItemSet set = WorkItemSet::parse("1:3,5:6,9:12");
    for (const std::int64_t begin : {0, 2, 4, 5, 9, 20}) {
        std::int64_t expected = begin;
        for (std::int64_t k = 0; k < 12; ++k, ++expected) {
            while (set.contains(expected)) ++expected;
            EXPECT_EQ(set.missing(k, begin), expected) << k << " from " << begin;
        }
    }
}

} // namespace keyhole
