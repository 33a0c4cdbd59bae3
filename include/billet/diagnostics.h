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

/// Kind of message: its key, its severity, its meaning, and what a user can do. Each kind is one
/// object in diagnostic_kinds.h; its constructor adds it to all_diagnostic_kinds().
class DiagnosticKind {
public:
  DiagnosticKind(const char *key, Severity severity, const char *meaning, const char *remedy);
  DiagnosticKind(const DiagnosticKind &) = delete;
  DiagnosticKind &operator=(const DiagnosticKind &) = delete;

  const char *const key;
  const Severity severity;
  const char *const meaning, *const remedy;
};

/// Returns every kind that the program knows, by ascending key.
std::vector<const DiagnosticKind *> all_diagnostic_kinds();
/// Returns the kind with this key. Throws std::out_of_range.
const DiagnosticKind &diagnostic_kind(const std::string &key);

/// Returns all kinds as a JSON array of objects.
std::string describe_diagnostic_kinds_as_json();

/// Message about a run: its kind, what happened, where, and what to do. The setters return the
/// object itself, so that a message is written as one expression.
class Diagnostic {
public:
  /// Makes a message. `what`: a sentence without its full stop.
  Diagnostic(const DiagnosticKind &kind, std::string what) : kind_(&kind), what_(std::move(what)) {}

  Diagnostic &body(const std::string &name) { return part("body", name); }
  Diagnostic &pair(const std::string &name) { return part("pair", name); }
  Diagnostic &tool(const std::string &name) { return part("tool", name); }
  Diagnostic &support(const std::string &name) { return part("support", name); }
  /// Sets the place in the scene file: "scene.prm:12: 'Radius' in ...".
  Diagnostic &origin(const std::string &text) { return part("origin", text); }
  /// Sets the name of a part; `what` is one of the five above. An empty name is left out.
  Diagnostic &part(const std::string &what, const std::string &name);
  Diagnostic &at(const dealii::Tensor<1, 3> &position) {
    position_ = position;
    return *this;
  }
  Diagnostic &time(const double t) {
    time_ = t;
    return *this;
  }
  /// Adds a number for programs that read the message.
  Diagnostic &value(const std::string &name, const double number) {
    values_.emplace_back(name, number);
    return *this;
  }
  /// Sets the number that ranks messages of this kind; the summary shows the largest.
  Diagnostic &measure(const std::string &name, const double number) {
    measure_ = number;
    return value(name, number);
  }
  /// Replaces the remedy of the kind. `text`: sentences without the last full stop.
  Diagnostic &advice(std::string text) {
    advice_ = std::move(text);
    return *this;
  }
  /// Distinguishes messages of one kind about the same parts; not printed.
  Diagnostic &topic(std::string text) {
    topic_ = std::move(text);
    return *this;
  }
  /// Keeps bytes for the program itself, such as a SceneFault; not printed.
  Diagnostic &data(std::string bytes) {
    data_ = std::move(bytes);
    return *this;
  }
  /// Replaces the kind; the rest stays.
  Diagnostic &change_kind(const DiagnosticKind &kind) {
    kind_ = &kind;
    return *this;
  }

  const DiagnosticKind &kind() const { return *kind_; }
  const std::string &what() const { return what_; }
  const std::string &data() const { return data_; }
  const std::optional<double> &time() const { return time_; }
  const std::optional<double> &measure() const { return measure_; }
  const std::vector<std::pair<std::string, double>> &values() const { return values_; }
  /// Returns the name of a part, such as the pair; empty if none is given.
  std::string part(const std::string &what) const;
  std::string advice() const;
  /// Returns key, names of parts and topic, which identify repetitions of the message.
  std::string identity() const;

  /// Returns "warning[key]: What happened (pair 'top', time 0.3). What to do."
  std::string text() const;
  /// Returns the message as one JSON object on one line.
  std::string json() const;

  /// Returns all of the message as bytes, for other ranks; deserialize() makes the same message of
  /// them.
  std::string serialize() const;
  static Diagnostic deserialize(const std::string &bytes);

private:
  const DiagnosticKind *kind_;
  std::string what_, advice_, topic_, data_;
  std::vector<std::pair<std::string, std::string>> parts_;
  std::vector<std::pair<std::string, double>> values_;
  std::optional<dealii::Tensor<1, 3>> position_;
  std::optional<double> time_, measure_;
};

/// Appends sentences to a text without its last full stop; either may be empty.
inline void append_sentences(std::string &text, const std::string &more) {
  text += (text.empty() || more.empty() ? "" : ". ") + more;
}

/// Cause of a failure and what to do, as parts of a later Diagnostic.
struct Explanation {
  std::string what;   ///< clause without its full stop
  std::string advice; ///< sentences without the last full stop; may be empty

  bool empty() const { return what.empty(); }
  /// Appends a clause that begins with its own separator, and its advice.
  Explanation &operator+=(const Explanation &next) {
    what += next.what;
    append_sentences(advice, next.advice);
    return *this;
  }
};

using DiagnosticList = std::vector<Diagnostic>;

/// Returns all of the messages as bytes, for other ranks; deserialize() makes the same messages of
/// them.
std::string serialize(const DiagnosticList &diagnostics);
DiagnosticList deserialize(const std::string &bytes);

/// Returns {"file": ..., "valid": false, "diagnostics": [...]}, the description of a refused scene.
std::string describe_refusal_as_json(const std::string &file, const DiagnosticList &why);

/// Returns the first message of this kind in the list, or null.
const Diagnostic *find(const DiagnosticList &list, const DiagnosticKind &kind);

/// Appends `more` to `list`.
void append(DiagnosticList &list, DiagnosticList more);

/// Collects the messages of a run. The first message with a given identity is printed and written
/// to a file of JSON lines; repetitions are counted. All ranks report the same messages.
class Diagnostics {
public:
  using Print = std::function<void(Severity, const std::string &)>;

  /// Makes an empty collection. `is_first`: this is the first rank, the only one that prints and
  /// writes.
  explicit Diagnostics(const bool is_first) : is_first_(is_first) {}

  /// Sets the function that prints later messages, without a final line end. If it is empty,
  /// nothing is printed.
  void set_print(Print print) { print_ = std::move(print); }

  /// Opens the file of JSON lines and writes the messages reported so far. Appends if `continues`.
  /// Throws InputError. First rank only.
  void open(const std::string &file_name, bool continues);

  void report(const Diagnostic &diagnostic);
  void report(const DiagnosticList &diagnostics);

  /// Returns the number of different messages of this severity; repetitions do not count.
  std::size_t count(Severity severity) const;
  /// Returns the number of different messages of this kind.
  std::size_t count(const DiagnosticKind &kind) const;
  /// Whether a message of this kind was reported.
  bool has(const DiagnosticKind &kind) const;
  /// Returns "1 error, 3 warnings"; empty if there is neither.
  std::string count_in_words() const;
  /// Returns one line for each warning or error that was reported more than once, or became worse
  /// after it was printed.
  std::vector<std::string> repetitions() const;
  /// Writes the last JSON line, {"summary": ...}, which counts the reports of each message. Returns
  /// false if the file could not be written.
  bool write_summary(int exit_code);
  const std::string &file_name() const { return file_name_; }

  /// Saves and restores all reports so far, for checkpoints. load() skips kinds that the program
  /// does not know.
  std::string save() const;
  void load(const std::string &state);

private:
  struct Entry {
    Diagnostic first;
    std::size_t n = 1;
    std::optional<double> worst, worst_time; ///< largest measure and its time
  };
  void write_line(const std::string &line);

  bool is_first_;
  Print print_;
  std::vector<Entry> entries_; ///< in the order of their first reports
  std::map<std::string, std::size_t> index_;
  std::vector<std::string> unwritten_; ///< JSON lines that precede open()
  std::ofstream file_;
  std::string file_name_;
};

} // namespace billet

#endif
