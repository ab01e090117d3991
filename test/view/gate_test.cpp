#include "view/gate.hpp"

#include <catch2/catch.hpp>

#include "skein/error.hpp"
#include "view/server.hpp"

using namespace skein::view;

namespace {

const std::string kToken = "0123456789abcdef";

Visit visit() { return {"GET", "/?token=0123456789abcdef", "", "", "foxglove.websocket.v1", true}; }

unsigned verdict(const Visit& visit, const std::vector<std::string>& origins = {}) {
  const auto refusal = Gate(kToken, origins).refusal(visit);
  return refusal ? refusal->status : 0;
}

}  // namespace

TEST_CASE("Who has the token may look, wherever in the query it stands") {
  auto one = visit();
  CHECK(verdict(one) == 0);
  one.target = "/view?a=b&token=0123456789abcdef&c";
  CHECK(verdict(one) == 0);
}

TEST_CASE("Nobody may look without the whole token") {
  const auto target =
      GENERATE("", "/", "/?", "/?token=", "/?token=0123456789abcde", "/?token=0123456789abcdeF",
               "/?token=0123456789abcdef0", "/?token=&token=0123456789abcdef",
               "/?tokens=0123456789abcdef", "/token=0123456789abcdef", "?&&&=&token");
  auto one = visit();
  one.target = target;
  CAPTURE(target);
  CHECK(verdict(one) == 401);
}

TEST_CASE("Pages of other origins may not look where origins are named; programs may") {
  auto one = visit();
  one.origin = "https://evil.example";
  CHECK(verdict(one) == 0);
  CHECK(verdict(one, {"http://localhost:8080"}) == 403);
  one.origin = "http://localhost:8080";
  CHECK(verdict(one, {"http://localhost:8080"}) == 0);
  one.origin = "http://localhost:80800";
  CHECK(verdict(one, {"http://localhost:8080"}) == 403);
  one.origin = "";
  CHECK(verdict(one, {"http://localhost:8080"}) == 0);
}

TEST_CASE("A browser that opens the address as a page is told what it is for") {
  auto one = visit();
  one.upgrade = false;
  CHECK(verdict(one) == 426);
  const auto refusal = Gate(kToken, {}).refusal(one);
  CHECK(refusal->text.find("Lichtblick") != std::string::npos);
}

TEST_CASE("Clients must offer the protocol, among others if they like") {
  auto one = visit();
  one.protocols = "foxglove.sdk.v1 ,\tfoxglove.websocket.v1";
  CHECK(verdict(one) == 0);
  const auto protocols =
      GENERATE("", ",", "foxglove.websocket.v2", "foxglove.websocket.v1x", "x,y");
  one.protocols = protocols;
  CAPTURE(protocols);
  CHECK(verdict(one) == 400);
}

TEST_CASE("Tokens that are short, or do not fit into a URL, are refused") {
  CHECK_THROWS_AS(Gate("", {}), skein::InvalidArgument);
  CHECK_THROWS_AS(Gate("0123456789abcde", {}), skein::InvalidArgument);
  CHECK_THROWS_AS(Gate("0123456789abcde&", {}), skein::InvalidArgument);
  CHECK_NOTHROW(Gate(random_token(), {}));
  CHECK(random_token() != random_token());
}
