// Access to the page of `skein designer`.
#include "command/designer/site.hpp"

#include <catch2/catch.hpp>

#include "command/designer/requests.hpp"
#include "skein/error.hpp"

using namespace skein;
using namespace skein::command::designer;
using Catch::Contains;

namespace {

const std::string kToken = "0123456789abcdef";
const std::string kFolder = "/0123456789abcdef/";
const std::string kName = "127.0.0.1:8080";

struct OpenSite {
  OpenSite() { site.listens_at(8080); }
  view::Reply get(const std::string& target, const std::string& host = kName,
                  const std::string& origin = "", const std::string& method = "GET") const {
    const auto reply = site.reply({method, target, host, origin, "", false});
    return reply ? *reply : view::Reply{101, ""};
  }

  std::shared_ptr<const std::string> state;
  Site site{kToken, {[this](auto) { return state; }}};
};

std::string header(const view::Reply& reply, const std::string& name) {
  for (const auto& [each, value] : reply.headers)
    if (each == name) return value;
  return "";
}

Actions actions(std::string& asked, bool faults = false) {
  return {[&asked](int launcher, const std::string& request) {
            asked = std::to_string(launcher) + ": " + request;
            return std::string("done");
          },
          [&asked](const std::string& entity, Place to) {
            asked = entity + " to " + std::to_string(to.x) + ", " + std::to_string(to.y);
          },
          [&asked] { asked = "arrange"; }, faults};
}

}  // namespace

TEST_CASE("who knows the token gets the page and its parts") {
  const OpenSite site;
  CHECK(site.site.url() == "http://127.0.0.1:8080/0123456789abcdef/");
  const auto page = site.get(kFolder);
  CHECK(page.status == 200);
  CHECK_THAT(page.text, Contains("<!doctype html>"));
  CHECK(header(page, "Content-Type") == "text/html; charset=utf-8");
  CHECK_THAT(header(page, "Content-Security-Policy"),
             Contains("default-src 'none'") && !Contains("unsafe"));
  CHECK(header(page, "Referrer-Policy") == "no-referrer");
  CHECK(header(site.get(kFolder + "main.js"), "Content-Type") == "text/javascript; charset=utf-8");
  CHECK(site.get(kFolder + "style.css?x=y").status == 200);
  CHECK(header(site.get("/0123456789abcdef"), "Location") == kFolder);
}

TEST_CASE("without the whole token there is nothing") {
  const OpenSite site;
  const auto target = GENERATE("", "/", "//", "/index.html", "/0123456789abcde/",
                               "/0123456789abcdeF/", "/0123456789abcdef0/", "/?0123456789abcdef/",
                               "/x/0123456789abcdef/", "0123456789abcdef/", "/socket", "*");
  CAPTURE(target);
  const auto reply = site.get(target);
  CHECK(reply.status == 401);
  CHECK_THAT(reply.text, Contains("Open the URL that `skein designer` has printed"));
}

TEST_CASE("a name that somebody gave this address, and pages of other origins, are turned away") {
  const OpenSite site;
  const auto host = GENERATE("", "evil.example", "evil.example:8080", "127.0.0.1", "127.0.0.1:80",
                             "127.0.0.1:8080.evil.example", "localhost", "0.0.0.0:8080");
  CAPTURE(host);
  CHECK(site.get(kFolder, host).status == 403);
  CHECK(site.get(kFolder, kName, std::string("http://") + host).status == 403);
}

TEST_CASE("its own page may ask, by both names") {
  const OpenSite site;
  CHECK(site.get(kFolder, "localhost:8080", "http://localhost:8080").status == 200);
  CHECK(site.get(kFolder, kName, "http://127.0.0.1:8080").status == 200);
  CHECK(site.get(kFolder, kName, "https://127.0.0.1:8080").status == 403);
  CHECK(site.get(kFolder, kName, "null").status == 403);
}

TEST_CASE("no path leads to a file that is not of the page") {
  const OpenSite site;
  const auto name = GENERATE("../etc/passwd", "..%2fetc%2fpasswd", "/etc/passwd", "main.js/",
                             "main.js/..", "./main.js", "%6dain.js", "page_files.cpp.in");
  CAPTURE(name);
  CHECK(site.get(kFolder + name).status == 404);
}

TEST_CASE("only GET is answered") {
  CHECK(OpenSite().get(kFolder, kName, "", GENERATE("POST", "PUT", "DELETE", "HEAD")).status ==
        405);
}

TEST_CASE("a WebSocket is there for who asks for one") {
  const OpenSite site;
  CHECK(site.get(kFolder + "socket").status == 426);
  CHECK(!site.site.reply({"GET", kFolder + "socket", kName, "http://" + kName, "", true}));
  CHECK(site.site.reply({"GET", kFolder + "socket", kName, "http://evil.example", "", true})
            ->status == 403);
}

TEST_CASE("programs read the state, once there is one") {
  OpenSite site;
  CHECK(site.get(kFolder + "state.json").status == 503);
  site.state = std::make_shared<const std::string>("{}");
  CHECK(site.get(kFolder + "state.json").text == "{}");
  CHECK(site.get(kFolder + "times.json").text == "null");
}

TEST_CASE("of a recording there is a state for each time, and no WebSocket") {
  Site site(kToken, {[](std::optional<std::uint64_t> at) {
                       if (at == 9) throw InvalidArgument("damaged");
                       return std::make_shared<const std::string>(std::to_string(at.value_or(0)));
                     },
                     std::make_shared<const std::string>("{}")});
  site.listens_at(8080);
  const auto get = [&](const std::string& name, bool upgrade = false) {
    return site.reply({"GET", kFolder + name, kName, "", "", upgrade});
  };
  CHECK(get("times.json")->text == "{}");
  CHECK(get("state.json?at=1796000000000000001")->text == "1796000000000000001");
  CHECK(get("state.json?at=9")->status == 500);
  CHECK(get("socket", true)->status == 404);
  const auto wrong = GENERATE("", "x", "-1", "1.5", "99999999999999999999999", "7&x");
  CAPTURE(wrong);
  CHECK(get(std::string("state.json?at=") + wrong)->status == 400);
}

TEST_CASE("before the site knows its port it turns everybody away") {
  const Site site(kToken, {[](auto) { return nullptr; }});
  CHECK(site.reply({"GET", kFolder, "127.0.0.1:0", "", "", false})->status == 200);
  CHECK(site.reply({"GET", kFolder, kName, "", "", false})->status == 403);
  CHECK_THROWS_WITH(Site("short", {}), Contains("at least 16"));
}

TEST_CASE("the page asks launchers for what they can do") {
  std::string asked;
  CHECK(obey(R"({"do": "restart", "launcher": 7, "process": "navigator/AStar"})", actions(asked)) ==
        "done");
  CHECK(asked == "7: restart navigator/AStar");
  obey(R"({"do": "stop", "launcher": 7})", actions(asked));
  CHECK(asked == "7: stop");
  obey(R"({"do": "kill", "launcher": 7, "process": "a"})", actions(asked, true));
  CHECK(asked == "7: kill a");
  obey(R"({"do": "move", "entity": "a/b", "x": 1, "y": -2.5})", actions(asked));
  CHECK(asked == "a/b to 1.000000, -2.500000");
  obey(R"({"do": "arrange"})", actions(asked));
  CHECK(asked == "arrange");
}

TEST_CASE("a request that is none does nothing, and is told why") {
  const auto [request, reason] = GENERATE(table<std::string, std::string>({
      {"", "a request is a JSON object"},
      {"[]", "a request is a JSON object"},
      {"{}", "the request has no member 'do'"},
      {R"({"do": 7})", "the member 'do' is no text"},
      {R"({"do": "fly"})", "'fly' can not be asked for; restart, stop"},
      {R"({"do": "stop"})", "the request has no member 'launcher'"},
      {R"({"do": "stop", "launcher": "7"})", "the member 'launcher' is no number"},
      {R"({"do": "stop", "launcher": 1e300})", "the member 'launcher' is no number, or too great"},
      {R"({"do": "restart", "launcher": 7, "process": "a\nstop"})", "no process has such a name"},
      {R"({"do": "kill", "launcher": 7, "process": "a"})", "only with --faults"},
      {R"({"do": "hang", "launcher": 7, "process": "a"})", "only with --faults"},
      {R"({"do": "move", "entity": "a", "x": 1e9, "y": 0})", "the member 'x' is no number, or too"},
  }));
  std::string asked;
  CAPTURE(request);
  CHECK_THROWS_WITH(obey(request, actions(asked)), Contains(reason));
  CHECK(asked.empty());
}
