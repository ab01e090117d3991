#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "traffic/advisory.hpp"

namespace traffic_daidalus_test {

using namespace reconnaissance;

// The judge is NASA's reference implementation: figures that DAIDALUS 2.0.4 (github.com/nasa/
// daidalus) with its configuration DO_365B_no_SUM.conf gives for these encounters in a plane.

namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kKnot_m_s = kNauticalMile_m / 3600;
constexpr double kFootPerMinute_m_s = kFoot_m / 60;

using Ranges = std::vector<std::pair<double, double>>;

struct Encounter {
  double own_course_deg, own_speed_kt, own_climb_ft_min;  // at the origin, 2000 m high
  double course_deg, speed_kt, climb_ft_min, east_m, north_m, height_m;
  int alert;           // 1 preventive, 2 corrective, 3 warning
  double in_s, out_s;  // of the corrective volume within 180 s; -1: never
  Ranges free_courses_deg, free_climbs_ft_min;
};

// Members in that order; the ranges between bars.
constexpr const char* kEncounters = R"(
132 103 0 5 232 500 1289 -9374 1749  2 44.819 67.382
    | 33 112 172 353 | -6000 -3200 200 6000 |
35 116 -100 26 133 0 189 -545 2030  3 0.000 135.221
    |  |  |
263 116 -600 298 170 600 331 -1078 1623  2 39.344 45.498
    | 0 254 321 360 | -400 6000 |
76 107 600 269 96 0 6271 1333 2339  1 66.220 72.524
    | 0 360 | -6000 700 4800 6000 |
161 136 0 114 226 -400 -7205 -854 2036  2 46.064 85.217
    | 0 133 341 360 | -6000 -900 400 6000 |
86 103 -700 265 92 0 6978 -414 1745  2 33.138 76.612
    | 0 81 124 360 | -6000 -2500 -300 6000 |
83 86 0 306 127 -600 4981 -1624 2233  2 31.444 63.170
    | 0 37 120 292 325 360 | -6000 -400 |
321 154 0 106 136 0 -5530 4227 2184  1 -1 -1
    | 0 360 | -6000 100 |
54 86 0 338 129 0 5009 -2382 2115  2 37.394 94.632
    | 82 354 | -6000 -200 1400 6000 |
81 107 -600 222 92 -300 4526 3306 1990  3 20.301 65.954
    | 0 33 88 360 | -6000 -1900 1100 6000 |
284 116 0 263 254 0 4157 2394 1982  3 21.317 74.845
    | 104 272 | -6000 -1600 1200 6000 |
196 131 0 175 273 -100 -3586 9248 1952  0 81.666 136.995
    | 16 282 | -6000 6000 |
76 123 0 281 103 -400 4180 6 2057  3 0.000 47.424
    |  |  |
100 104 700 174 156 -800 3032 6143 2464  2 43.089 78.892
    | 0 42 129 360 | -6000 -200 2000 6000 |
56 151 0 88 209 0 -3099 2778 2046  2 26.348 91.922
    | 77 236 | -6000 -800 1500 6000 |
7 148 100 10 250 -500 -1404 -5376 2434  0 97.388 128.549
    | 0 360 | -6000 6000 |
289 144 0 123 292 0 -10031 6741 2033  3 18.905 55.697
    | 0 288 329 360 | -6000 -1200 2000 6000 |
65 116 0 356 150 0 2669 -1770 1976  3 0.003 54.850
    |  |  |
208 93 -700 183 185 0 -1869 4365 1752  2 40.422 105.820
    | 28 194 | -6000 -2000 -200 6000 |
68 103 0 297 208 600 16637 -2941 1788  0 77.959 114.554
    | 0 360 | -6000 6000 |
113 153 0 20 274 0 1792 -8289 2029  3 15.083 57.887
    | 0 37 131 360 | -6000 -1600 2700 6000 |
208 101 700 316 234 0 5403 -11404 2290  2 50.115 95.145
    | 0 179 234 267 299 360 | -6000 300 1700 6000 |
322 83 -700 312 259 -400 2724 -2158 1997  3 0.000 51.320
    |  |  |
294 108 0 357 293 200 -4507 -12301 2032  0 60.043 103.504
    | 0 247 289 360 | -6000 6000 |
288 83 0 216 138 0 798 6405 1885  2 50.791 105.062
    | 0 226 357 360 | -6000 -1000 100 6000 |
226 116 -700 53 110 0 -2105 -1742 1879  3 0.000 34.067
    |  |  |
34 97 700 308 180 -300 2992 -692 2222  3 16.701 41.772
    |  | -6000 0 |
172 81 0 79 148 0 -7259 -5876 2130  0 65.529 119.087
    | 0 183 201 360 | -6000 6000 |
235 147 500 221 94 600 -1380 -1091 2043  3 0.000 82.178
    |  |  |
61 143 0 280 281 0 11526 235 1984  3 19.783 61.327
    | 0 46 87 262 290 360 | -6000 -1700 1300 6000 |
178 102 0 291 149 -600 5360 -5527 2082  2 32.711 71.903
    | 0 147 202 360 | -6000 -1000 800 6000 |
252 158 -500 152 96 300 -9378 1745 1567  1 72.795 105.319
    | 0 360 | -6000 -1800 -700 6000 |
)";

Ranges ranges(std::istream& in) {
  Ranges all;
  for (double low = 0, high = 0; in >> low >> high;) all.emplace_back(low, high);
  in.clear();
  in.ignore(1);  // the bar
  return all;
}

std::vector<Encounter> encounters() {
  std::istringstream in(kEncounters);
  std::vector<Encounter> all;
  for (Encounter e; in >> e.own_course_deg >> e.own_speed_kt >> e.own_climb_ft_min >>
                    e.course_deg >> e.speed_kt >> e.climb_ft_min >> e.east_m >> e.north_m >>
                    e.height_m >> e.alert >> e.in_s >> e.out_s;) {
    in >> std::ws;
    in.ignore(1);
    e.free_courses_deg = ranges(in);
    e.free_climbs_ft_min = ranges(in);
    all.push_back(e);
  }
  REQUIRE(all.size() == 32);
  return all;
}

TrafficState flying(double course_deg, double speed_kt, double climb_ft_min, Local place) {
  return {place, speed_kt * kKnot_m_s * std::cos(course_deg * kDegree),
          speed_kt * kKnot_m_s * std::sin(course_deg * kDegree), climb_ft_min * kFootPerMinute_m_s};
}

TrafficState own_of(const Encounter& e) {
  return flying(e.own_course_deg, e.own_speed_kt, e.own_climb_ft_min, {0, 0, 2000});
}

TrafficState other_of(const Encounter& e) {
  return flying(e.course_deg, e.speed_kt, e.climb_ft_min, {e.north_m, e.east_m, e.height_m});
}

const ManoeuvreLimits kLimits{.least_climb_m_s = -6000 * kFootPerMinute_m_s,
                              .greatest_climb_m_s = 6000 * kFootPerMinute_m_s};

struct Agreement {
  int same = 0, different = 0, free = 0;
};

/// Of intruders without corrective alert DAIDALUS judges a shorter time.
bool has_whole_bands(const Encounter& e) { return e.alert >= 2; }

/// Values nearer to a band's edge than the step are left out.
void compare(const std::vector<Manoeuvre>& tried, const Ranges& free, double unit, double step,
             bool circle, Agreement& agreement) {
  for (const Manoeuvre& one : tried) {
    double value = one.value / unit;
    if (circle && value < 0) value += 360;
    bool inside = false;
    bool at_edge = false;
    for (const auto& [low, high] : free) {
      inside = inside || (value >= low && value <= high);
      const bool low_is_edge = !circle || low > 0;
      const bool high_is_edge = !circle || high < 360;
      at_edge = at_edge || (low_is_edge && std::abs(value - low) < 1.01 * step) ||
                (high_is_edge && std::abs(value - high) < 1.01 * step);
    }
    if (at_edge) continue;
    ++(inside == one.free ? agreement.same : agreement.different);
    agreement.free += one.free;
    if (inside != one.free) WARN("differs at " << value << ", free there: " << inside);
  }
}

// Own course, speed and climb rate (degrees, knots, ft/min; 2000 m high at the origin), the same of
// the other and where it is (east, north, up in metres); then the courses that DAIDALUS 2.0.4 with
// DO_365B_no_SUM.conf marks as those of recovery, where none keeps well clear.
constexpr const char* kRecoveries = R"(
90 115 0 300 198 -100 2798 -441 2120 | 102 270 |
217 145 0 324 268 0 908 -2033 1920 | 37 240 |
213 105 0 188 93 0 -994 -76 1951 | 33 162 |
227 99 -800 139 294 300 -5028 1891 1989 | 0 47 257 360 |
127 113 200 104 185 0 -1185 -657 1900 | 0 78 307 360 |
92 151 -300 152 267 0 301 2866 1882 | 173 272 |
161 158 0 10 255 300 -957 -7216 1974 | 0 158 341 360 |
181 115 0 181 245 500 -269 2226 1998 | 1 137 |
261 159 -200 17 192 0 -1874 -566 1943 | 81 253 |
212 145 0 180 208 0 -1415 1664 1950 | 32 179 |
63 113 0 229 262 300 5424 4789 1916 | 82 243 |
315 147 600 300 122 0 -19 1274 2031 | 135 292 |
249 110 -500 56 176 500 -4560 -1507 1910 | 69 237 |
46 141 300 46 177 100 -1448 17 2021 | 50 226 |
319 121 -300 27 109 300 -1269 -105 1879 | 64 139 |
48 153 0 119 98 0 -504 547 2052 | 47 95 |
37 141 200 145 214 0 -465 3558 2136 | 217 351 |
68 103 0 298 273 0 7204 -1482 2018 | 97 248 |
347 90 -800 315 287 200 1298 -1046 1860 | 1 167 |
220 134 -100 23 242 0 -1918 -3269 2069 | 40 176 |
255 97 0 47 130 600 -825 -928 1972 | 0 75 272 360 |
90 92 -100 173 249 700 345 3069 1938 | 95 111 |
78 105 -800 351 121 -400 637 -273 2023 | 87 258 |
96 114 0 140 164 0 275 1028 1999 | 172 276 |
332 141 0 344 125 600 964 -442 1992 | 152 330 |
223 122 0 336 97 -600 -457 -1491 2103 | 43 189 |
189 129 0 195 178 0 840 982 2071 | 0 9 227 360 |
107 92 -400 346 278 0 1306 -2760 2048 | 94 287 |
176 122 0 5 267 0 -189 -5148 2087 | 0 111 234 360 |
332 99 0 262 261 0 1898 2130 2035 | 152 273 |
229 85 0 47 197 0 -2546 -3684 1967 | 0 49 240 360 |
76 151 400 159 112 -700 311 480 1982 | 82 256 |
359 136 -500 231 134 700 818 2945 1964 | 43 179 |
327 111 0 64 282 -800 -2092 131 2101 | 147 316 |
61 85 -800 89 98 0 -1081 181 2051 | 49 241 |
135 110 0 335 82 300 965 -1716 2014 | 0 98 315 360 |
6 107 600 177 256 -400 -121 4980 2088 | 67 186 |
249 92 500 283 169 0 1206 -1338 2072 | 0 69 312 360 |
92 124 0 112 271 0 -1975 529 1886 | 0 66 272 360 |
244 82 0 82 158 -500 -3039 -1887 2050 | 0 64 251 360 |
)";

}  // namespace

TEST_CASE("alert levels and times of violation are those of DAIDALUS") {
  for (const Encounter& e : encounters()) {
    CAPTURE(e.east_m);
    CHECK(static_cast<int>(alert_without_memory(own_of(e), other_of(e))) == e.alert);
    const auto violated = violation(own_of(e), other_of(e), kEnRoute, 180);
    REQUIRE(violated.has_value() == (e.in_s >= 0));
    if (!violated) continue;
    CHECK(violated->in_s == Approx(e.in_s).margin(0.001));
    CHECK(violated->out_s == Approx(e.out_s).margin(0.001));
  }
}

TEST_CASE("courses that keep well clear are those of DAIDALUS") {
  Agreement agreement;
  for (const Encounter& e : encounters()) {
    if (!has_whole_bands(e)) continue;
    const std::vector others{other_of(e)};
    compare(course_bands(own_of(e), others, kEnRoute, kLimits), e.free_courses_deg, kDegree, 1,
            true, agreement);
  }
  CHECK(agreement.different == 0);
  CHECK(agreement.same > 8000);
  CHECK(agreement.free > 4000);
}

TEST_CASE("climb rates that keep well clear are those of DAIDALUS") {
  Agreement agreement;
  for (const Encounter& e : encounters()) {
    if (!has_whole_bands(e)) continue;
    const std::vector others{other_of(e)};
    compare(climb_bands(own_of(e), others, kEnRoute, kLimits), e.free_climbs_ft_min,
            kFootPerMinute_m_s, 100, false, agreement);
  }
  CHECK(agreement.different == 0);
  CHECK(agreement.same > 2000);
  CHECK(agreement.free > 1000);
}

TEST_CASE("an alert is raised, kept and dropped over time as by DAIDALUS") {
  // One letter a second: what the intruder, head-on, would be alerted for. A dash: 6 s without it.
  struct History {
    std::string seen;
    std::string shown;
  };
  const std::vector<History> histories{
      {"...kk..cckk.pppxxkccpp..wwwwxxx.pkp...p...x...cpkxxxx..cckk-p",
       "00000000222221112222221113333333311100000000000112222222222-1"},
      {"...pppp...wcpppckpppp-c..xx-kxxxcxxppp-pppppckxx-xxxwc-www.cccwkx",
       "000011111002222111111-22222-0022222221-111111122-22222-3333333333"},
      {".wccpxx-cckc-cwkkkkkcckpppckk..pxxxwkpw....-..p...kkxcccwpxp-pcx",
       "0022222-2222-222222222222111111112222233330-0000000002222222-112"},
      {"..ppkkxxppppcwcxppkpxxxxxccckxp....c.wc...wwwwwww.wxxxxxxxxx",
       "000111122221122222212222222222221000022220033333333333333333"},
      {".....wwpppppp...ppppp..wwcccc.pppp.-..cccppppppxkkkkkcccpww..",
       "00000033331111100111111133333331111-0002222111111111112222333"},
      {"..ccwwwcccc-cxxx-xc-ccccckkk-kkkxxwwxxxwwppwwwwwwwwwwpppppwwwwww",
       "00022333333-2222-22-22222222-00002233333333333333333333111133333"},
      {"...kkkkkkkkkkkkkkkckkxx-xxxxxxxxkkxpp........ccckkxxxxxxx.kkk",
       "00000000000000000000022-2222222222222110000000222222222222222"},
      {"........-....xxxxxwwwwwwwwwwww-www-ww-wwwwwwwk-k-kpwwwwwwx-xxxxkxpp",
       "00000000-000002222233333333333-333-33-33333333-0-001333333-22222222"},
  };
  const auto head_on = [](char seen) {
    const double in_s = seen == 'w'   ? 20  // warning
                        : seen == 'x' ? 35  // warning if it is shown, else corrective
                        : seen == 'c' ? 40  // corrective
                        : seen == 'p' ? 40  // preventive: 600 ft higher
                        : seen == 'k' ? 65  // corrective if it is shown, else nothing
                                      : 300;
    const double tau_m = 35 * 150.0;
    const double range_m =
        (tau_m + std::sqrt(tau_m * tau_m + 4 * kEnRoute.distance_m * kEnRoute.distance_m)) / 2;
    return TrafficState{{range_m + in_s * 150, 0, seen == 'p' ? 600 * kFoot_m : 0.0}, -90, 0, 0};
  };
  for (const auto& [seen, shown] : histories) {
    Alert alert;
    std::string answers;
    double now_s = 0;
    for (const char one : seen) {
      now_s += one == '-' ? 6 : 1;
      answers +=
          one == '-'
              ? '-'
              : static_cast<char>('0' + static_cast<int>(alert.assess(TrafficState{{}, 60, 0, 0},
                                                                      head_on(one), now_s)));
    }
    CHECK(answers == shown);
  }
}

TEST_CASE("where no course keeps well clear, the advised one is among DAIDALUS's for recovery") {
  std::istringstream in(kRecoveries);
  int count = 0;
  double own_course, own_speed, own_climb, course, speed, climb, east, north, up;
  while (in >> own_course >> own_speed >> own_climb >> course >> speed >> climb >> east >> north >>
         up) {
    const TrafficState own = flying(own_course, own_speed, own_climb, {0, 0, 2000});
    const std::vector others{flying(course, speed, climb, {north, east, up})};
    // Courses only.
    ManoeuvreLimits limits;
    limits.least_climb_m_s = limits.greatest_climb_m_s = own.up_m_s;
    const ResolutionAdvisory advisory =
        BandsAvoider(limits).advise(own, others, own.course_rad(), AlertLevel::Warning);
    CAPTURE(own_course, course, east, north);
    REQUIRE(advisory.course_rad);
    CHECK(advisory.recovery);
    const double advised = std::fmod(*advisory.course_rad / kDegree + 360, 360);
    bool inside = false;
    in >> std::ws;
    in.ignore(1);
    for (const auto& [low, high] : ranges(in))
      inside = inside || (advised >= low - 0.01 && advised <= high + 0.01);
    CHECK(inside);
    ++count;
  }
  CHECK(count == 40);
}

}  // namespace traffic_daidalus_test
