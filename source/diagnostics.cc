// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/diagnostics.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <sstream>

namespace billet {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::array<const char *, 5> part_names = {{"body", "pair", "tool", "support", "origin"}};

std::vector<const DiagnosticKind *> &registry() {
  static std::vector<const DiagnosticKind *> kinds;
  return kinds;
}

/// Returns a JSON number, or null for a value that is not finite.
Json number(const double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string print(const double value, const int digits) {
  std::ostringstream text;
  text.precision(digits);
  text << value;
  return text.str();
}

bool ends_sentence(const std::string &text) {
  return !text.empty() && (text.back() == '.' || text.back() == '?' || text.back() == '!');
}

} // namespace

const char *to_string(const Severity severity) {
  switch (severity) {
  case Severity::note:
    return "note";
  case Severity::warning:
    return "warning";
  case Severity::error:
    return "error";
  }
  return "";
}

DiagnosticKind::DiagnosticKind(const char *key, const Severity severity, const char *meaning,
                               const char *remedy)
    : key(key), severity(severity), meaning(meaning), remedy(remedy) {
  registry().push_back(this);
}

std::vector<const DiagnosticKind *> all_diagnostic_kinds() {
  std::vector<const DiagnosticKind *> kinds = registry();
  std::sort(kinds.begin(), kinds.end(),
            [](const DiagnosticKind *a, const DiagnosticKind *b) { return std::strcmp(a->key, b->key) < 0; });
  return kinds;
}

namespace {

/// Returns the kind with this key, or null.
const DiagnosticKind *find_kind(const std::string &key) {
  const auto &kinds = registry();
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const DiagnosticKind *kind) { return kind->key == key; });
  return found == kinds.end() ? nullptr : *found;
}

} // namespace

const DiagnosticKind &diagnostic_kind(const std::string &key) {
  if (const DiagnosticKind *kind = find_kind(key))
    return *kind;
  throw std::out_of_range("no kind of message has the key '" + key + "'");
}

Diagnostic &Diagnostic::part(const std::string &what, const std::string &name) {
  if (!name.empty())
    parts_.emplace_back(what, name);
  return *this;
}

std::string Diagnostic::part(const std::string &what) const {
  const auto found =
      std::find_if(parts_.begin(), parts_.end(), [&](const auto &part) { return part.first == what; });
  return found == parts_.end() ? "" : found->second;
}

std::string Diagnostic::advice() const { return advice_.empty() ? kind_->remedy : advice_; }

std::string Diagnostic::identity() const {
  std::string identity = kind_->key;
  for (const auto &[what, name] : parts_)
    identity += "\n" + what + "\n" + name;
  return topic_.empty() ? identity : identity + "\n\n" + topic_;
}

std::string Diagnostic::text() const {
  std::string where;
  const auto add = [&where](const std::string &part) { where += (where.empty() ? "" : ", ") + part; };
  for (const auto &[what, name] : parts_)
    add(what == "origin" ? name : what + " '" + name + "'");
  if (position_)
    add("at (" + print((*position_)[0], 5) + ", " + print((*position_)[1], 5) + ", " +
        print((*position_)[2], 5) + ")");
  if (time_)
    add("time " + print(*time_, 6));
  std::string text = std::string(to_string(kind_->severity)) + "[" + kind_->key + "]: " + what_;
  if (!where.empty())
    text += " (" + where + ")";
  if (!ends_sentence(text))
    text += ".";
  const std::string remedy = advice();
  if (!remedy.empty())
    text += " " + remedy + (ends_sentence(remedy) ? "" : ".");
  return text;
}

namespace {

Json to_json(const Diagnostic &diagnostic) {
  Json object;
  object["key"] = diagnostic.kind().key;
  object["severity"] = to_string(diagnostic.kind().severity);
  object["message"] = diagnostic.what();
  for (const char *part : part_names)
    if (!diagnostic.part(part).empty())
      object[part] = diagnostic.part(part);
  if (diagnostic.time())
    object["time"] = number(*diagnostic.time());
  if (!diagnostic.values().empty()) {
    object["values"] = Json::object();
    for (const auto &[name, value] : diagnostic.values())
      object["values"][name] = number(value);
  }
  object["advice"] = diagnostic.advice();
  return object;
}

std::string dump(const Json &object) {
  return object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace

std::string Diagnostic::json() const {
  Json object = to_json(*this);
  if (position_)
    object["position"] = {number((*position_)[0]), number((*position_)[1]), number((*position_)[2])};
  return dump(object);
}

// CBOR, unlike JSON as text, holds any bytes of a string and numbers that are not finite.
std::string Diagnostic::serialize() const {
  Json object;
  object["key"] = kind_->key;
  object["message"] = what_;
  object["advice"] = advice_;
  object["topic"] = topic_;
  if (!data_.empty())
    object["data"] = Json::binary({data_.begin(), data_.end()});
  object["parts"] = Json::array();
  for (const auto &[what, name] : parts_)
    object["parts"].push_back(Json::array({what, name}));
  object["values"] = Json::array();
  for (const auto &[name, value] : values_)
    object["values"].push_back(Json::array({name, value}));
  if (position_)
    object["position"] = Json::array({(*position_)[0], (*position_)[1], (*position_)[2]});
  if (time_)
    object["time"] = *time_;
  if (measure_)
    object["measure"] = *measure_;
  const auto bytes = Json::to_cbor(object);
  return {bytes.begin(), bytes.end()};
}

Diagnostic Diagnostic::deserialize(const std::string &bytes) {
  const Json object = Json::from_cbor(bytes.begin(), bytes.end());
  Diagnostic diagnostic(diagnostic_kind(object.at("key").get<std::string>()),
                        object.at("message").get<std::string>());
  diagnostic.advice_ = object.at("advice").get<std::string>();
  diagnostic.topic_ = object.at("topic").get<std::string>();
  if (object.contains("data")) {
    const auto &data = object["data"].get_binary();
    diagnostic.data_.assign(data.begin(), data.end());
  }
  for (const Json &part : object.at("parts"))
    diagnostic.parts_.emplace_back(part.at(0).get<std::string>(), part.at(1).get<std::string>());
  for (const Json &value : object.at("values"))
    diagnostic.values_.emplace_back(value.at(0).get<std::string>(), value.at(1).get<double>());
  if (object.contains("position")) {
    const Json &position = object["position"];
    diagnostic.position_ = dealii::Tensor<1, 3>(
        {position.at(0).get<double>(), position.at(1).get<double>(), position.at(2).get<double>()});
  }
  if (object.contains("time"))
    diagnostic.time_ = object["time"].get<double>();
  if (object.contains("measure"))
    diagnostic.measure_ = object["measure"].get<double>();
  return diagnostic;
}

std::string describe_diagnostic_kinds_as_json() {
  Json kinds = Json::array();
  for (const DiagnosticKind *kind : all_diagnostic_kinds())
    kinds.push_back({{"key", kind->key},
                     {"severity", to_string(kind->severity)},
                     {"meaning", kind->meaning},
                     {"remedy", kind->remedy}});
  return kinds.dump(1);
}

std::string serialize(const DiagnosticList &diagnostics) {
  Json list = Json::array();
  for (const Diagnostic &diagnostic : diagnostics) {
    const std::string bytes = diagnostic.serialize();
    list.push_back(std::vector<unsigned char>(bytes.begin(), bytes.end()));
  }
  const auto bytes = Json::to_cbor(list);
  return {bytes.begin(), bytes.end()};
}

DiagnosticList deserialize(const std::string &bytes) {
  DiagnosticList diagnostics;
  for (const Json &entry : Json::from_cbor(bytes.begin(), bytes.end())) {
    const auto content = entry.get<std::vector<unsigned char>>();
    diagnostics.push_back(Diagnostic::deserialize({content.begin(), content.end()}));
  }
  return diagnostics;
}

std::string describe_refusal_as_json(const std::string &file, const DiagnosticList &why) {
  Json object;
  object["file"] = file;
  object["valid"] = false;
  object["diagnostics"] = Json::array();
  for (const Diagnostic &diagnostic : why)
    object["diagnostics"].push_back(Json::parse(diagnostic.json()));
  return dump(object);
}

const Diagnostic *find(const DiagnosticList &list, const DiagnosticKind &kind) {
  const auto found = std::find_if(list.begin(), list.end(),
                                  [&](const Diagnostic &diagnostic) { return &diagnostic.kind() == &kind; });
  return found == list.end() ? nullptr : &*found;
}

void append(DiagnosticList &list, DiagnosticList more) {
  list.insert(list.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

void Diagnostics::open(const std::string &file_name, const bool continues) {
  file_name_ = file_name;
  file_.open(file_name, continues ? std::ios::app : std::ios::trunc);
  if (!file_)
    throw InputError("'" + file_name + "' cannot be written");
  for (const auto &line : unwritten_)
    write_line(line);
  unwritten_.clear();
}

void Diagnostics::write_line(const std::string &line) {
  if (!is_first_)
    return;
  if (file_.is_open())
    file_ << line << std::endl; // flushed, since a run may end at any time
  else
    unwritten_.push_back(line);
}

void Diagnostics::report(const Diagnostic &diagnostic) {
  const auto [place, is_new] = index_.emplace(diagnostic.identity(), entries_.size());
  if (is_new) {
    entries_.push_back({diagnostic, 1, diagnostic.measure(), diagnostic.time()});
    write_line(diagnostic.json());
    // main() prints errors.
    if (is_first_ && print_ && diagnostic.kind().severity != Severity::error)
      print_(diagnostic.kind().severity, diagnostic.text());
    return;
  }
  Entry &entry = entries_[place->second];
  ++entry.n;
  if (diagnostic.measure() && entry.worst && *diagnostic.measure() > *entry.worst) {
    entry.worst = diagnostic.measure();
    entry.worst_time = diagnostic.time();
  }
}

void Diagnostics::report(const DiagnosticList &diagnostics) {
  for (const auto &diagnostic : diagnostics)
    report(diagnostic);
}

std::size_t Diagnostics::count(const Severity severity) const {
  return static_cast<std::size_t>(std::count_if(entries_.begin(), entries_.end(), [&](const Entry &entry) {
    return entry.first.kind().severity == severity;
  }));
}

std::size_t Diagnostics::count(const DiagnosticKind &kind) const {
  return static_cast<std::size_t>(std::count_if(
      entries_.begin(), entries_.end(), [&](const Entry &entry) { return &entry.first.kind() == &kind; }));
}

bool Diagnostics::has(const DiagnosticKind &kind) const { return count(kind) > 0; }

std::string Diagnostics::count_in_words() const {
  std::string words;
  for (const Severity severity : {Severity::error, Severity::warning}) {
    const std::size_t n = count(severity);
    if (n > 0)
      words +=
          (words.empty() ? "" : ", ") + std::to_string(n) + " " + to_string(severity) + (n == 1 ? "" : "s");
  }
  return words;
}

std::vector<std::string> Diagnostics::repetitions() const {
  std::vector<std::string> lines;
  for (const auto &entry : entries_) {
    const bool got_worse = entry.worst && *entry.worst > *entry.first.measure();
    if (entry.first.kind().severity == Severity::note || (entry.n == 1 && !got_worse))
      continue;
    std::string line =
        std::string(to_string(entry.first.kind().severity)) + "[" + entry.first.kind().key + "]";
    for (const char *part : part_names)
      if (!entry.first.part(part).empty())
        line += std::string(" ") + part + " '" + entry.first.part(part) + "'";
    line += ": " + std::to_string(entry.n) + " times";
    if (got_worse) {
      const auto &values = entry.first.values();
      const auto named = std::find_if(values.begin(), values.end(), [&](const auto &value) {
        return value.second == *entry.first.measure();
      });
      line += ", " + (named == values.end() ? std::string("at most") : named->first + " up to") + " " +
              print(*entry.worst, 3);
      if (entry.worst_time)
        line += " at time " + print(*entry.worst_time, 6);
    }
    lines.push_back(line);
  }
  return lines;
}

bool Diagnostics::write_summary(const int exit_code) {
  Json summary;
  summary["exit code"] = exit_code;
  for (const Severity severity : {Severity::error, Severity::warning, Severity::note})
    summary[std::string(to_string(severity)) + "s"] = count(severity);
  summary["messages"] = Json::array();
  for (const auto &entry : entries_) {
    Json message;
    message["key"] = entry.first.kind().key;
    for (const char *part : part_names)
      if (!entry.first.part(part).empty())
        message[part] = entry.first.part(part);
    message["count"] = entry.n;
    if (entry.worst)
      message["largest"] = number(*entry.worst);
    if (entry.worst_time)
      message["at time"] = number(*entry.worst_time);
    summary["messages"].push_back(message);
  }
  Json line;
  line["summary"] = summary;
  write_line(dump(line));
  return !file_.is_open() || file_.flush();
}

// CBOR, as for other ranks: the file of a checkpoint holds any bytes.
std::string Diagnostics::save() const {
  Json state = Json::array();
  for (const auto &entry : entries_) {
    Json object;
    object["key"] = entry.first.kind().key;
    object["message"] = entry.first.serialize();
    object["n"] = entry.n;
    if (entry.worst)
      object["worst"] = *entry.worst;
    if (entry.worst_time)
      object["worst time"] = *entry.worst_time;
    state.push_back(object);
  }
  const auto bytes = Json::to_cbor(state);
  return {bytes.begin(), bytes.end()};
}

void Diagnostics::load(const std::string &state) {
  const auto optional = [](const Json &object, const char *name) {
    return object.contains(name) ? std::optional<double>(object[name].get<double>()) : std::nullopt;
  };
  for (const Json &object : Json::from_cbor(state.begin(), state.end())) {
    if (find_kind(object.at("key").get<std::string>()) == nullptr)
      continue;
    const Diagnostic diagnostic = Diagnostic::deserialize(object.at("message").get<std::string>());
    if (index_.emplace(diagnostic.identity(), entries_.size()).second)
      entries_.push_back({diagnostic, object.at("n").get<std::size_t>(), optional(object, "worst"),
                          optional(object, "worst time")});
  }
}

} // namespace billet
