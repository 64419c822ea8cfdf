// The sweep of the plane cut's parameters.
#include "study/cut2d_sweep.h"

#include <gtest/gtest.h>

#include "study/cut2d_sweep_page.h"

namespace trocar {
namespace {

TEST(Cut2dSweep, samples_are_repeatable_and_ordered) {
  const Cut2dSample a = sample_cuts({}, 3), b = sample_cuts({}, 3);
  EXPECT_EQ(a.n_cuts, 12);
  EXPECT_EQ(a.n_refused, 0);
  EXPECT_EQ(a.worst, b.worst);
  EXPECT_EQ(a.median, b.median);
  EXPECT_EQ(a.area_sigma, b.area_sigma);
  EXPECT_LE(a.worst, a.low);
  EXPECT_LE(a.low, a.median);
  EXPECT_GT(a.seconds, 0);
}

// A value that is the default of a setting must give the same cuts as the setting itself.
TEST(Cut2dSweep, each_parameter_holds_its_default) {
  for (const Cut2dParameter& parameter : cut2d_parameters())
    for (const int setting : {1, 2}) {
      int n_defaults = 0;
      for (const Cut2dValue& value : parameter.values) {
        CutPlaneOptions options = cut2d_setting(setting);
        value.set(options);
        n_defaults += options == cut2d_setting(setting) ? 1 : 0;
      }
      EXPECT_EQ(n_defaults, 1) << parameter.name << " " << cut2d_setting_names[setting];
    }
}

Cut2dParameter made_up() {
  Cut2dParameter parameter{"rings", "vicinity", {}};
  for (const int n : {2, 3}) {
    const double low = 0.1 * n;
    const Cut2dSample sample{8, 0, low / 2, low, 2 * low, 0.05, 1e-3};
    parameter.values.push_back(
        {std::to_string(n), [n](CutPlaneOptions& o) { o.rings = n; }, {sample, sample, sample}});
  }
  return parameter;
}

TEST(Cut2dSweep, section_names_the_best_value_and_its_rows) {
  const std::string text = parameter_section(made_up());
  EXPECT_NE(text.find("best 5 % quantile 0.300 at 3"), std::string::npos) << text;
  EXPECT_NE(text.find("| robust | 0.400 | 0.200 | 0.100 | 0 | 0.050 | 1000 us |"),
            std::string::npos)
      << text;
}

TEST(Cut2dSweep, page_shows_a_plot_for_each_parameter) {
  const std::string page = sweep_page({made_up(), made_up()}, 2);
  EXPECT_NE(page.find("8 random straight cuts"), std::string::npos);
  EXPECT_NE(page.find("(images/cutting_rings.svg)"), std::string::npos);
  const std::string svg = parameter_svg(made_up());
  std::size_t n_curves = 0;
  for (std::size_t at = svg.find("<polyline"); at != std::string::npos;
       at = svg.find("<polyline", at + 1))
    ++n_curves;
  EXPECT_EQ(n_curves, 2u * n_cut2d_settings);
}

}  // namespace
}  // namespace trocar
