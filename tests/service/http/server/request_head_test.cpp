#include "service/http/server/request_head.hpp"

#include <gtest/gtest.h>

#include "service/http/server/ends.hpp"

namespace cell {
namespace {

TEST(RequestHead, FieldsAreFoundInAnyCaseAndListsAreJoined) {
  const RequestHead head{.fields = {{"host", "a"}, {"If-None-Match", "1"}, {"IF-NONE-MATCH", "2"}}};
  EXPECT_EQ(head.field("Host"), "a");
  EXPECT_EQ(head.field("Origin"), std::nullopt);
  EXPECT_EQ(head.count("if-none-match"), 2u);
  EXPECT_EQ(head.list_field("If-None-Match"), "1, 2");
}

TEST(RequestHead, AHeadIsAGetToTheRoutes) {
  EXPECT_EQ((RequestHead{.method = "HEAD"}).route_method(), "GET");
  EXPECT_EQ((RequestHead{.method = "POST"}).route_method(), "POST");
  EXPECT_EQ(RequestHead{}.route_method(), "GET");
}

TEST(RequestHead, WhatDecidesSomethingStandsOnce) {
  const Ends ends = Ends::of_unix_socket();
  const RequestHead good{.method = "GET", .target = "/", .fields = {{"Host", "a"}}};
  EXPECT_FALSE(find_http_fault(good, ends));
  for (const char* name : {"Authorization", "Content-Type", "Idempotency-Key", "Origin", "Content-Length"}) {
    RequestHead twice = good;
    for (int i = 0; i < 2; ++i) twice.fields.emplace_back(name, "1");
    EXPECT_EQ(find_http_fault(twice, ends).value_or(Problem{.status = 0}).status, 400u) << name;
  }
}

}  // namespace
}  // namespace cell
