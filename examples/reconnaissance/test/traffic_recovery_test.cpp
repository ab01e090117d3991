#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <sstream>
#include <vector>

#include "traffic/advisory.hpp"

namespace traffic_recovery_test {

using namespace reconnaissance;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

TrafficState flying(double course_deg, double speed_kt, double climb_ft_min, Local place) {
  const double speed_m_s = speed_kt * kNauticalMile_m / 3600;
  return {place, speed_m_s * std::cos(course_deg * kDegree),
          speed_m_s * std::sin(course_deg * kDegree), climb_ft_min * kFoot_m / 60};
}

// Own course, speed and climb rate (degrees, knots, ft/min; 2000 m high at the origin), the same of
// the other and where it is (east, north, up in metres); then the courses that DAIDALUS 2.0.4 with
// DO_365B_no_SUM.conf marks as those of recovery, where none keeps well clear.
constexpr const char* kEncounters = R"(
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

TEST_CASE("where no course keeps well clear, the advised one is among DAIDALUS's for recovery") {
  std::istringstream in(kEncounters);
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
    for (double low = 0, high = 0; in >> low >> high;) {
      inside = inside || (advised >= low - 0.01 && advised <= high + 0.01);
    }
    CHECK(inside);
    in.clear();
    in.ignore(1);
    ++count;
  }
  CHECK(count == 40);
}

}  // namespace traffic_recovery_test
