// SPDX-License-Identifier: BSD-3-Clause
// The exercises at the end of a tutorial's page: with --check a program says whether the reader's
// answers are right. It computes the right ones for that; none is stored.
#pragma once

#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/number.hpp"

namespace photonav {

struct Exercise {
    std::function<double()> answer;
    double tolerance = 0.02;  ///< relative
};

/// Says of an answer whether it is right, too small or too large. @return whether it is right
inline bool reportAnswer(std::size_t number, double given, const Exercise& exercise) {
    const double right = exercise.answer();
    const bool isRight = std::abs(given - right) <= exercise.tolerance * std::abs(right);
    const char* verdict = isRight ? "right" : given < right ? "too small" : "too large";
    std::printf("exercise %zu: %g is %s\n", number, given, verdict);
    return isRight;
}

inline bool asksForCheck(int argc, char** argv) {
    return argc > 1 && std::string(argv[1]) == "--check";
}

/// Handles `--check ANSWER1 [ANSWER2]`, where "-" leaves an exercise out. There is no other option.
/// @return exit code: 0 all right, 1 not all, 2 not understood; none where no check is asked for
inline std::optional<int> checkAnswers(int argc, char** argv,
                                       const std::vector<Exercise>& exercises) {
    const bool isOption = argc > 1 && std::string(argv[1]).starts_with("--");
    if (!isOption) return {};
    const std::vector<std::string> texts(argv + 2, argv + argc);
    std::vector<std::optional<double>> given;
    bool isUnderstood =
        asksForCheck(argc, argv) && !texts.empty() && texts.size() <= exercises.size();
    for (const std::string& text : texts) {
        given.push_back(numberIn(text));
        isUnderstood = isUnderstood && (given.back() || text == "-");
    }
    if (!isUnderstood) {
        std::fprintf(stderr, "usage: %s --check ANSWER1 [ANSWER2] (numbers; - leaves one out)\n",
                     argv[0]);
        return 2;
    }
    bool isRight = true;
    for (std::size_t i = 0; i < given.size(); ++i) {
        if (given[i]) isRight = reportAnswer(i + 1, *given[i], exercises[i]) && isRight;
    }
    return isRight ? 0 : 1;
}

}  // namespace photonav
