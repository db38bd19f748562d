// SPDX-License-Identifier: BSD-3-Clause
#include "io/yaml_reader.hpp"

#include <gtest/gtest.h>

#include "reason_of.hpp"
#include "temporary_folder.hpp"

namespace photonav::test {
namespace {

/// What is said about a YAML file of these bytes, or nothing.
std::string saidAbout(std::string_view bytes) {
    const TemporaryFolder folder;
    const std::string file = folder.write("a.yaml", std::string(bytes));
    const std::string reason = reasonOf([&] { loadYaml(file); });
    const auto start = reason.find("a.yaml: ");
    return start == std::string::npos ? reason : reason.substr(start);
}

TEST(YamlFile, WhatCannotStartAValueIsRefusedAndNotReadWithoutEnd) {
    EXPECT_EQ(saidAbout(",1,2\n"), "a.yaml: line 1: is not YAML");
    EXPECT_EQ(saidAbout("\n\n, a: 1\n"), "a.yaml: line 3: is not YAML");
}

TEST(YamlFile, BinaryFilesAreRefusedAsSuch) {
    EXPECT_EQ(saidAbout(std::string_view("\0,\0\0# a\n: b", 12)),
              "a.yaml: is no text in UTF-8: it has zero bytes");
    EXPECT_EQ(saidAbout(std::string_view("\x7f"
                                         "ELF\2\1\1\0\0",
                                         9)),
              "a.yaml: is no text in UTF-8: it has zero bytes");
}

TEST(YamlFile, AZeroByteFarFromTheBeginningIsRefused) {
    for (const std::size_t length : {10U, 2000U, 200000U}) {
        const std::string text = "a: 1\n# " + std::string(length, 'x') + "\nb: 2" + '\0';
        EXPECT_EQ(saidAbout(text + "\nc: 3\n"), "a.yaml: is no text in UTF-8: it has zero bytes");
    }
}

TEST(YamlFile, AKeyWithoutValueIsNotTheWordNull) {
    const TemporaryFolder folder;
    for (const char* none : {"", " ~", " null"}) {
        const std::string file = folder.write("a.yaml", "file:" + std::string(none) + "\n");
        std::string value = "default";
        YamlMap map(file, loadYaml(file));
        EXPECT_EQ(reasonOf([&] { map.read("file", value); }), file + ": file: has no value");
        EXPECT_EQ(value, "default");
    }
}

TEST(YamlFile, DeepNestingIsRefused) {
    // Appended: GCC 12 takes the sum of a literal and such a string for an overflow.
    const std::string deep = std::string("a:\n").append(100000, '[');
    EXPECT_EQ(saidAbout(deep), "a.yaml: line 2: is nested too deeply");
}

TEST(YamlFile, SecondDocumentsAreRefused) {
    EXPECT_EQ(saidAbout("a: 1\n---\nb: 2\n"),
              "a.yaml: holds several documents ('---'); only one is read");
    EXPECT_EQ(saidAbout("---\na: 1\n"), "nothing was thrown");
    EXPECT_EQ(saidAbout("a: 1\n"), "nothing was thrown");
    EXPECT_EQ(saidAbout(""), "nothing was thrown");
    EXPECT_EQ(saidAbout("# only a comment\n"), "nothing was thrown");
}

}  // namespace
}  // namespace photonav::test
