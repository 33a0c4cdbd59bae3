// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/certify.h"

#include "billet/errors.h"
#include "billet/material/subroutine_messages.h"
#include "billet/material/user_subroutine.h"
#include "billet/parameters/other_units.h"
#include "billet/scene/expression.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iterator>
#include <memory>
#include <ostream>
#include <sstream>

#include <unistd.h>

namespace billet {

namespace {

const char *describe(const Finding::Verdict verdict) {
  switch (verdict) {
  case Finding::Verdict::passed:
    return "pass";
  case Finding::Verdict::failed:
    return "FAIL";
  case Finding::Verdict::reported:
    break;
  }
  return "-";
}

std::string number(const double x) {
  std::ostringstream text;
  text.precision(3);
  text << x;
  return text.str();
}

using Row = std::vector<std::string>;

/// Prints rows with columns of equal width, the first one as a head.
void print_table(const std::vector<Row> &rows, const PageFormat format, std::ostream &stream) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const Row &row : rows)
    for (std::size_t c = 0; c < row.size(); ++c)
      widths[c] = std::max(widths[c], row[c].size());
  const bool is_markdown = format == PageFormat::markdown;
  for (const Row &row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      const bool is_last = c + 1 == row.size();
      stream << (is_markdown ? "| " : "  ") << std::left
             << std::setw(is_last && !is_markdown ? 0 : static_cast<int>(widths[c])) << row[c]
             << (is_markdown ? " " : "");
    }
    stream << (is_markdown ? "|\n" : "\n");
    if (is_markdown && &row == &rows.front()) {
      for (const std::size_t width : widths)
        stream << "|" << std::string(width + 2, '-');
      stream << "|\n";
    }
  }
}

std::string bound(const double stretch, const bool is_open) {
  return number(stretch) + (is_open ? " or beyond" : "");
}

/// Whether the file has more than parameters of a material.
bool is_scene(const std::string &file) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string first;
    words >> first;
    if (first == "subsection")
      return true;
  }
  return !stream.eof(); // reading the scene refuses it
}

/// File that exists as long as the object.
class TemporaryScene {
public:
  explicit TemporaryScene(const std::string &text)
      : name_((std::filesystem::temp_directory_path() / ("billet_" + std::to_string(getpid()) + ".prm"))
                  .string()) {
    std::ofstream stream(name_);
    stream << text;
    stream.close();
    if (!stream)
      throw InputError("'" + name_ + "' cannot be written, which the certification of a material needs");
  }
  ~TemporaryScene() {
    std::error_code ignored;
    std::filesystem::remove(name_, ignored);
  }
  TemporaryScene(const TemporaryScene &) = delete;
  TemporaryScene &operator=(const TemporaryScene &) = delete;

  const std::string &name() const { return name_; }

private:
  std::string name_;
};

} // namespace

void print(const Certificate &certificate, const std::string &title, const PageFormat format,
           std::ostream &stream) {
  const bool is_markdown = format == PageFormat::markdown;
  stream << (is_markdown ? "# " : "") << title << (is_markdown ? "\n\n" : "\n");
  std::vector<Row> rows = {{"property", "verdict", "value", "allowed", "remark"}};
  for (const Finding &finding : certificate.findings)
    rows.push_back({finding.property, describe(finding.verdict), number(finding.value),
                    finding.verdict == Finding::Verdict::reported ? "" : number(finding.allowed),
                    finding.remark});
  print_table(rows, format, stream);
  stream << "\nStretches in which the law has a stress and is elliptic, in steps of 2 %:\n"
         << (is_markdown ? "\n" : "");
  rows = {{"path", "from", "to"}};
  for (const SafeRange &range : certificate.ranges)
    rows.push_back(
        {range.mode, bound(range.minimum, range.is_open_below), bound(range.maximum, range.is_open_above)});
  print_table(rows, format, stream);
  stream << "\n"
         << (certificate.has_passed() ? "The law passes" : "The law FAILS") << ", after "
         << number(certificate.seconds) << " s.\n\n";
}

bool certify_laws(const std::string &file, const std::vector<SceneFile::Setting> &settings,
                  const PageFormat format, std::ostream &stream) {
  // Part of the end time, for schemes whose steps follow from the mesh.
  constexpr double explicit_part = 1e-3;
  std::unique_ptr<const TemporaryScene> of_material;
  if (!is_scene(file))
    of_material = std::make_unique<const TemporaryScene>(
        "subsection Bodies\n  subsection material\n    subsection Material\n      include " +
        std::filesystem::absolute(file).string() + "\n    end\n  end\nend\n");
  const std::string name = of_material ? of_material->name() : file;
  const auto read = [&](const parameters::Settings &more) {
    parameters::Settings all = more;
    std::copy_if(settings.begin(), settings.end(), std::back_inserter(all), [&more](const auto &setting) {
      return std::none_of(more.begin(), more.end(),
                          [&setting](const auto &other) { return other.path == setting.path; });
    });
    return parameters::Scene::read(name, "", all);
  };
  const parameters::Scene scene = read({});
  const std::vector<OtherUnits> other_units =
      parameters::in_other_units(scene, SceneFile::read(name, settings).entries(), read);
  bool have_passed = true;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const parameters::Body &body = scene.bodies[b];
    const PointLaw &law = *body.material.law;
    CertificationSettings settings_of_law;
    settings_of_law.other_units = other_units[b];
    settings_of_law.dt = scene.scheme().has_matrix ? scene.time_stepping.initial_step
                                                   : explicit_part * scene.time_stepping.end_time;
    if (law.depends_on_temperature())
      settings_of_law.temperature = Expression(body.material.temperature.value, Expression::Variables::time,
                                               scene.amplitudes, body.material.temperature.origin)
                                        .value(0.);
    const Certificate certificate = certify(law, settings_of_law);
    const auto *const user_law = find_user_subroutine(law);
    print(certificate,
          "Body '" + body.name + "': " + (user_law != nullptr ? user_law->title() : certificate.law), format,
          stream);
    if (user_law != nullptr && user_law->refusal().is_final)
      stream << user_law->refusal().what << ".\n\n";
    for (const SubroutineMessage &message : take_subroutine_messages())
      stream << "Said " << message.n << (message.n == 1 ? " time: " : " times: ") << message.text << "\n\n";
    have_passed = have_passed && certificate.has_passed();
  }
  return have_passed;
}

} // namespace billet
