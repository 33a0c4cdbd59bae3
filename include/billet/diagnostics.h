// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DIAGNOSTICS_H
#define BILLET_DIAGNOSTICS_H

#include <deal.II/base/tensor.h>

#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace billet {

enum class Severity { note, warning, error };
const char *to_string(Severity severity);

/// A kind of message: what it is called, how serious it is, what it means and what a user can do. Each kind
/// is one object in diagnostic_kinds.h, and enters all_diagnostic_kinds() by being constructed.
class DiagnosticKind {
public:
  DiagnosticKind(const char *key, Severity severity, const char *meaning, const char *remedy);
  DiagnosticKind(const DiagnosticKind &) = delete;
  DiagnosticKind &operator=(const DiagnosticKind &) = delete;

  const char *const key;
  const Severity severity;
  const char *const meaning, *const remedy;
};

/// Every kind that the program knows, by ascending key.
std::vector<const DiagnosticKind *> all_diagnostic_kinds();
/// The kind of this key; throws std::out_of_range.
const DiagnosticKind &diagnostic_kind(const std::string &key);

/// The same as a JSON array of objects.
std::string describe_diagnostic_kinds_as_json();

/// One message about a run: its kind, what happened, where, and what to do. The setters return the object
/// itself, so that a message is written as one expression.
class Diagnostic {
public:
  /// `what`: a sentence without its full stop.
  Diagnostic(const DiagnosticKind &kind, std::string what) : kind_(&kind), what_(std::move(what)) {}

  Diagnostic &body(const std::string &name) { return part("body", name); }
  Diagnostic &pair(const std::string &name) { return part("pair", name); }
  Diagnostic &tool(const std::string &name) { return part("tool", name); }
  Diagnostic &support(const std::string &name) { return part("support", name); }
  /// Where in the scene file: "scene.prm:12: 'Radius' in ...".
  Diagnostic &origin(const std::string &text) { return part("origin", text); }
  /// `what` is one of the five above. An empty name is left out.
  Diagnostic &part(const std::string &what, const std::string &name);
  Diagnostic &at(const dealii::Tensor<1, 3> &position) {
    position_ = position;
    return *this;
  }
  Diagnostic &time(const double t) {
    time_ = t;
    return *this;
  }
  /// A number that belongs to the message, for programs that read it.
  Diagnostic &value(const std::string &name, const double number) {
    values_.emplace_back(name, number);
    return *this;
  }
  /// The number by which one message of this kind is worse than another: the summary shows the largest.
  Diagnostic &measure(const std::string &name, const double number) {
    measure_ = number;
    return value(name, number);
  }
  /// Sentences without the last full stop; in place of the remedy of the kind.
  Diagnostic &advice(std::string text) {
    advice_ = std::move(text);
    return *this;
  }

  const DiagnosticKind &kind() const { return *kind_; }
  const std::string &what() const { return what_; }
  const std::optional<double> &time() const { return time_; }
  const std::optional<double> &measure() const { return measure_; }
  const std::vector<std::pair<std::string, double>> &values() const { return values_; }
  /// The name of a part, such as the pair's; empty: none is given.
  std::string part(const std::string &what) const;
  std::string advice() const;
  /// What tells it from others of its kind: the names in it.
  std::string identity() const;

  /// "warning[key]: What happened (pair 'top', time 0.3). What to do."
  std::string text() const;
  /// The same as one JSON object, on one line.
  std::string json() const;

private:
  const DiagnosticKind *kind_;
  std::string what_, advice_;
  std::vector<std::pair<std::string, std::string>> parts_;
  std::vector<std::pair<std::string, double>> values_;
  std::optional<dealii::Tensor<1, 3>> position_;
  std::optional<double> time_, measure_;
};

using DiagnosticList = std::vector<Diagnostic>;

/// {"file": ..., "valid": false, "diagnostics": [...]}, as a refused scene is described.
std::string describe_refusal_as_json(const std::string &file, const Diagnostic &why);

/// The first message of this kind in the list, or null.
const Diagnostic *find(const DiagnosticList &list, const DiagnosticKind &kind);

/// Appends `more` to `list`.
void append(DiagnosticList &list, DiagnosticList more);

/// Collects the messages of a run. Each is printed, and written to a file of JSON lines, the first time that
/// its kind is reported with these names; later ones are counted. All ranks report the same.
class Diagnostics {
public:
  using Print = std::function<void(Severity, const std::string &)>;

  /// `is_first`: this is the first rank, the only one that prints and writes.
  explicit Diagnostics(const bool is_first) : is_first_(is_first) {}

  /// From here on texts are printed by this, without a last line end; none: nothing is printed.
  void set_print(Print print) { print_ = std::move(print); }

  /// From here on, and for what was reported before, writes JSON lines to `file_name`; at its end if
  /// `continues`. Throws InputError. First rank only.
  void open(const std::string &file_name, bool continues);

  void report(const Diagnostic &diagnostic);
  void report(const DiagnosticList &diagnostics);

  /// Different ones of this severity; what was only counted does not add to it.
  std::size_t count(Severity severity) const;
  /// Whether one of this kind was reported.
  bool has(const DiagnosticKind &kind) const;
  /// "3 warnings, 1 note", empty if there is nothing to count.
  std::string count_in_words() const;
  /// One line for each message that was reported more than once, or got worse after it was printed.
  std::vector<std::string> repetitions() const;
  /// Writes the last JSON line, {"summary": ...}, with how often each message was reported. False if the file
  /// could not be written.
  bool write_summary(int exit_code);
  const std::string &file_name() const { return file_name_; }

  /// For checkpoints: what has been reported so far, and back.
  std::string save() const;
  void load(const std::string &state);

private:
  struct Entry {
    Diagnostic first;
    std::size_t n = 1;
    std::optional<double> worst, worst_time; ///< largest measure, and when
  };
  void write_line(const std::string &line);

  bool is_first_;
  Print print_;
  std::vector<Entry> entries_; ///< in the order in which they came
  std::map<std::string, std::size_t> index_;
  std::vector<std::string> unwritten_; ///< while there is no file
  std::ofstream file_;
  std::string file_name_;
};

} // namespace billet

#endif
