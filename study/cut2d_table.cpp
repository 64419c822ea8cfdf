#include "study/cut2d_table.h"

#include <array>

#include "base/number_text.h"
#include "cutting/cut_plane_paper.h"
#include "study/study_text.h"

namespace trocar {

namespace {

constexpr std::array<const char*, 14> heads = {
    "Config", "Mesh",  "From",  "#N",    "#E",     "A min", "A max",
    "A mean", "A sig", "E min", "E max", "E mean", "E sig", "t best / median"};
constexpr std::array<const char*, 14> units = {"",     "",     "",   "",   "",   "mm^2", "mm^2",
                                               "mm^2", "mm^2", "mm", "mm", "mm", "mm",   ""};
constexpr std::size_t first_number = 3;
using Cells = std::array<std::string, 14>;

std::string time_text(const Cut2dRow& row) {
  if (row.best_seconds <= 0) return "";
  if (row.best_seconds == row.median_seconds) return seconds_text(row.best_seconds);
  return with_decimals(1e6 * row.best_seconds, 0) + " / " +
         with_decimals(1e6 * row.median_seconds, 0) + " us";
}

Cells cells_of(const Cut2dRow& row) {
  const PlaneStatistics& s = row.statistics;
  return {row.configuration > 0 ? std::to_string(row.configuration) : "",
          row.kind,
          row.source,
          std::to_string(s.n_nodes),
          std::to_string(s.n_elements),
          with_decimals(s.area.min, 2),
          with_decimals(s.area.max, 2),
          with_decimals(s.area.mean, 2),
          with_decimals(s.area.sigma, 2),
          with_decimals(s.edge.min, 1),
          with_decimals(s.edge.max, 1),
          with_decimals(s.edge.mean, 1),
          with_decimals(s.edge.sigma, 1),
          time_text(row)};
}

// Cells of a row, marked where a row without freedom differs from the printed one above it.
Cells marked_cells(const std::vector<Cut2dRow>& rows, std::size_t k) {
  Cells cells = cells_of(rows[k]);
  const bool is_fixed = rows[k].source == "ours" && k > 0 && rows[k - 1].source == "printed" &&
                        rows[k].configuration <= 4;
  const Cells printed = is_fixed ? cells_of(rows[k - 1]) : cells;
  for (std::size_t c = first_number; c + 1 < cells.size(); ++c)
    if (cells[c] != printed[c]) cells[c] += "#";
  return cells;
}

Cells texts(const std::array<const char*, 14>& words) {
  Cells cells;
  for (std::size_t c = 0; c < cells.size(); ++c) cells[c] = words[c];
  return cells;
}

std::string padded(const std::string& text, std::size_t width, bool is_right) {
  const std::string space(width - std::min(width, text.size()), ' ');
  return is_right ? space + text : text + space;
}

std::string line(const Cells& cells, const std::array<std::size_t, 14>& width) {
  std::string text;
  for (std::size_t c = 0; c < cells.size(); ++c)
    text += padded(cells[c], width[c], c >= first_number) +
            (c == 4 || c == 8 || c == 12 ? " | " : "  ");
  return text;
}

bool is_first_of_mesh(const std::vector<Cut2dRow>& rows, std::size_t k) {
  return k == 0 || rows[k].configuration != rows[k - 1].configuration;
}

Cut2dRow measured(int configuration, const char* kind, const char* source,
                  const PlaneStatistics& statistics) {
  return {configuration, kind, source, statistics, 0, 0, ""};
}

Cut2dRow trial_row(int configuration, Cut2dMode mode, const char* source, int repetitions) {
  const Cut2dTrial trial = run_trial(paper_mesh(configuration), {paper_cut(configuration)},
                                     options_of(mode, repetitions));
  Cut2dRow row = measured(configuration, mode == Cut2dMode::subdivision ? "OR" : "NR", source,
                          trial.statistics_after);
  row.best_seconds = trial.best_seconds;
  row.median_seconds = trial.median_seconds;
  return row;
}

}  // namespace

std::vector<Cut2dRow> paper_rows(int repetitions) {
  std::vector<Cut2dRow> rows;
  for (const PaperRow& paper : paper_table()) {
    const int c = paper.configuration;
    constexpr std::array<const char*, 3> kinds = {"I", "OR", "NR"};
    rows.push_back({c, kinds[static_cast<std::size_t>(paper.kind)], "printed", paper.printed,
                    paper.seconds, paper.seconds, paper.misprint});
    if (paper.kind == PaperRowKind::initial) {
      rows.push_back(measured(c, "I", "ours", plane_statistics(paper_mesh(c))));
    } else if (paper.kind == PaperRowKind::old_remeshing) {
      rows.push_back(trial_row(c, Cut2dMode::subdivision, "ours", repetitions));
    } else {
      rows.push_back(trial_row(c, Cut2dMode::paper, "published mode", repetitions));
      rows.push_back(trial_row(c, Cut2dMode::robust, "robust mode", repetitions));
    }
  }
  return rows;
}

std::string rows_text(const std::vector<Cut2dRow>& rows) {
  std::vector<Cells> table = {texts(heads), texts(units)};
  for (std::size_t k = 0; k < rows.size(); ++k) table.push_back(marked_cells(rows, k));
  std::array<std::size_t, 14> width{};
  for (const Cells& cells : table)
    for (std::size_t c = 0; c < cells.size(); ++c) width[c] = std::max(width[c], cells[c].size());
  std::string text = line(table[0], width) + "\n" + line(table[1], width) + "\n";
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (is_first_of_mesh(rows, k)) text += "\n";
    text += line(table[k + 2], width) + rows[k].note + "\n";
  }
  return text;
}

std::string rows_markdown(const std::vector<Cut2dRow>& rows) {
  std::string text = "|", rule = "|";
  for (std::size_t c = 0; c < heads.size(); ++c) {
    text += std::string(" ") + heads[c] + " |";
    rule += c >= first_number ? "---:|" : "---|";
  }
  text += " note |\n" + rule + "---|\n";
  for (std::size_t k = 0; k < rows.size(); ++k) {
    text += "|";
    for (const std::string& cell : marked_cells(rows, k)) text += " " + cell + " |";
    text += " " + rows[k].note + " |\n";
  }
  return text;
}

}  // namespace trocar
