#include "service/documents/people_document.hpp"

#include <array>
#include <span>

#include "service/documents/internal/document_fields.hpp"
#include "service/documents/schemas.hpp"

namespace cell {
namespace {

constexpr std::string_view kSession = R"({
"type":"object",
"required":["schema","name","role","kind","ends_at","sign_in"],
"properties":{
  "schema":{"const":"touchcal/session/1"},
  "name":{"type":["string","null"],"description":"of the user, or of a named token"},
  "role":{"enum":["none","view","operate","engineer"],"description":"none too for a session that is over: it may stop the arm"},
  "kind":{"enum":["none","token","user"],"description":"token: in a file of the state directory; user: who signed in"},
  "ends_at":{"type":["string","null"],"description":"of a session that is not over"},
  "sign_in":{"type":"boolean","description":"whether there are users"}}})";

constexpr std::string_view kSignedIn = R"({
"type":"object",
"required":["schema","token","name","role","ends_at"],
"properties":{
  "schema":{"const":"touchcal/signed-in/1"},
  "token":{"type":"string","description":"send it as Authorization: Bearer"},
  "name":{"type":"string"},
  "role":{"enum":["view","operate","engineer"]},
  "ends_at":{"type":"string"}}})";

constexpr std::string_view kUsers = R"({
"type":"object",
"required":["schema","users"],
"properties":{
  "schema":{"const":"touchcal/users/1"},
  "users":{"type":"array","items":{
    "type":"object",
    "required":["name","role","created_at","created_by","last_sign_in_at","session_count"],
    "properties":{
      "name":{"type":"string"},
      "role":{"enum":["view","operate","engineer"]},
      "created_at":{"type":"string"},
      "created_by":{"type":["string","null"],"description":"the user or the named token who made it"},
      "last_sign_in_at":{"type":["string","null"]},
      "session_count":{"type":"integer","minimum":0}}}}}})";

constexpr std::string_view kSignInRequest = R"({
"type":"object",
"additionalProperties":false,
"required":["name","secret"],
"properties":{"name":{"type":"string"},"secret":{"type":"string"}}})";

constexpr std::string_view kSecretRequest = R"({
"type":"object",
"additionalProperties":false,
"required":["secret","new_secret"],
"properties":{"secret":{"type":"string"},"new_secret":{"type":"string","minLength":6,"maxLength":128}}})";

constexpr std::string_view kUserRequest = R"({
"type":"object",
"additionalProperties":false,
"required":["name","role"],
"properties":{
  "name":{"type":"string","minLength":1,"maxLength":64},
  "role":{"enum":["view","operate","engineer"]},
  "secret":{"type":"string","minLength":6,"maxLength":128,"description":"left out: that of the user who is there stays"}}})";

constexpr std::array kPeopleSchemas{DocumentSchema{"Session", kSession},
                                    DocumentSchema{"SignedIn", kSignedIn},
                                    DocumentSchema{"Users", kUsers},
                                    DocumentSchema{"SignInRequest", kSignInRequest},
                                    DocumentSchema{"SecretRequest", kSecretRequest},
                                    DocumentSchema{"UserRequest", kUserRequest}};

}  // namespace

std::span<const DocumentSchema> people_schemas() { return kPeopleSchemas; }

std::string document_text(const SessionDocument& document) { return written(document); }
std::string document_text(const SignedInDocument& document) { return written(document); }
std::string document_text(const UsersDocument& document) { return written(document); }
std::string document_text(const UserRequestDocument& document) { return written(document); }

UsersDocument read_users(std::string_view text) {
  return document_from<UsersDocument>(text, Absent::kIsRefused);
}

}  // namespace cell
