// SPDX-License-Identifier: BSD-3-Clause
#include "report/report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "io/atomic_file.hpp"
#include "io/durable_file.hpp"

namespace photonav {

/// app/report/page and its libraries in one piece, made by cmake/embed_report.cmake.
extern const std::string_view kReportPage;

namespace {

constexpr std::string_view kDataMark = "@PHOTONAV_DATA@";

/// JSON inside <script>: no '<' may be left that could end or open an element.
std::string escapedForScript(std::string_view text) {
    std::string escaped;
    escaped.reserve(text.size());
    for (const char character : text)
        if (character == '<')
            escaped += "\\u003c";
        else
            escaped += character;
    return escaped;
}

}  // namespace

std::string lengthText(double metres) {
    return std::abs(metres) < 0.1 ? fmt::format("{:.3g} mm", 1e3 * metres)
                                  : fmt::format("{:.3f} m", metres);
}

Eigen::Vector2d fieldOfView(const Camera& camera) {
    return {2. * std::atan(0.5 * camera.width / camera.fx()),
            2. * std::atan(0.5 * camera.height / camera.fy())};
}

std::string reportPage(std::string_view content) {
    const std::size_t mark = kReportPage.find(kDataMark);
    std::string page(kReportPage.substr(0, mark));
    page += escapedForScript(content);
    page += kReportPage.substr(mark + kDataMark.size());
    return page;
}

void writeReport(const std::filesystem::path& file, std::string_view content) {
    replaceFile(file, reportPage(content));
}

Png writeFigure(const std::filesystem::path& folder, const std::string& name,
                const Figure& figure) {
    Png png = figure.png();
    writeFileAtomically(folder / (name + ".png"), png);
    figure.save(folder / (name + ".svg"));
    figure.save(folder / (name + ".pdf"));
    return png;
}

void writeResultFolder(const std::filesystem::path& folder, ReportData& report,
                       const std::vector<NamedFigure>& figures) {
    for (const auto& [name, caption, figure] : figures)
        report.figures.push_back({caption, writeFigure(folder, name, figure)});
    if (!report.config.empty()) writeFileAtomically(folder / "config.yaml", report.config);
    const std::string text = reportJson(report);
    writeFileAtomically(folder / "report.json", text);
    writeReport(folder / "report.html", text);
}

}  // namespace photonav
