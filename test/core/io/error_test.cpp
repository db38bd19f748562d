// SPDX-License-Identifier: BSD-3-Clause
#include "io/error.hpp"

#include <gtest/gtest.h>

#include <string>

namespace photonav {
namespace {

TEST(InputErrors, AreOneLineWhateverAFileHolds) {
    const InputError error("a.yaml", "key\n2", std::string("no \x1b[31m'\r\t\0' \xc3\xa9", 16));
    EXPECT_STREQ(error.what(), "a.yaml: key\\n2: no \\x1b[31m'\\x0d\\x09\\x00' \xc3\xa9");
    EXPECT_EQ(error.reason(), "key\\n2: no \\x1b[31m'\\x0d\\x09\\x00' \xc3\xa9");
}

}  // namespace
}  // namespace photonav
