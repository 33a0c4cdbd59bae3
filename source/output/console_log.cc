// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/console_log.h"

#include "billet/errors.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iostream>
#include <streambuf>

namespace billet {

namespace {

constexpr const char *erase_to_end = "\033[K";

} // namespace

/// Lines of both streams on their way to the file.
class ConsoleLog::Sink {
public:
  ~Sink() {
    if (file_ >= 0) {
      write_out(line_);
      close(file_);
    }
  }

  /// Takes the end of a line on the console as a terminal does: a carriage return takes back the
  /// line.
  void put(const char c) {
    if (c == '\r') {
      line_.clear();
      return;
    }
    line_ += c;
    const std::size_t n = std::strlen(erase_to_end);
    if (line_.size() >= n && line_.compare(line_.size() - n, n, erase_to_end) == 0)
      line_.erase(line_.size() - n);
    if (c == '\n') {
      write_out(line_);
      line_.clear();
    }
  }

  void open(const std::string &file_name, const bool continues) {
    file_ = ::open(file_name.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (file_ < 0)
      throw InputError("'" + file_name + "' cannot be written: " + std::strerror(errno));
    if (flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      close(file_);
      file_ = -1;
      throw InputError("another run writes to '" + file_name +
                       "'; allowed is a folder that no other run uses, such as one given by '--output'");
    }
    if (!continues && ftruncate(file_, 0) != 0)
      errno = 0; // a device or a pipe has no length
    const std::string before = std::move(before_);
    before_.clear();
    write_out(before);
  }

private:
  /// A full disk must not end the run: the console has the text.
  void write_out(const std::string &text) {
    if (file_ < 0)
      before_ += text;
    else
      for (std::size_t done = 0; done < text.size();) {
        const ssize_t n = write(file_, text.data() + done, text.size() - done);
        if (n <= 0 && errno != EINTR)
          return;
        done += n > 0 ? static_cast<std::size_t>(n) : 0;
      }
  }

  int file_ = -1;
  std::string line_, before_;
};

/// Buffer of a stream that passes on all characters, and copies them.
class ConsoleLog::Copy : public std::streambuf {
public:
  Copy(std::ostream &stream, Sink &sink) : stream_(stream), console_(stream.rdbuf(this)), sink_(sink) {}
  ~Copy() override { stream_.rdbuf(console_); }
  Copy(const Copy &) = delete;
  Copy &operator=(const Copy &) = delete;

protected:
  int_type overflow(const int_type character) override {
    if (traits_type::eq_int_type(character, traits_type::eof()))
      return traits_type::not_eof(character);
    sink_.put(traits_type::to_char_type(character));
    return console_->sputc(traits_type::to_char_type(character));
  }
  std::streamsize xsputn(const char *text, const std::streamsize n) override {
    for (std::streamsize i = 0; i < n; ++i)
      sink_.put(text[i]);
    return console_->sputn(text, n);
  }
  int sync() override { return console_->pubsync(); }

private:
  std::ostream &stream_;
  std::streambuf *console_;
  Sink &sink_;
};

/// Stream into the file alone.
class ConsoleLog::Entry : private std::streambuf {
public:
  explicit Entry(Sink &sink) : stream(this), sink_(sink) {}

  std::ostream stream;

private:
  int_type overflow(const int_type character) override {
    if (!traits_type::eq_int_type(character, traits_type::eof()))
      sink_.put(traits_type::to_char_type(character));
    return traits_type::not_eof(character);
  }

  Sink &sink_;
};

ConsoleLog::ConsoleLog()
    : sink_(std::make_unique<Sink>()), output_(std::make_unique<Copy>(std::cout, *sink_)),
      errors_(std::make_unique<Copy>(std::cerr, *sink_)), entry_(std::make_unique<Entry>(*sink_)) {}

ConsoleLog::~ConsoleLog() = default; // the copies end before the sink

void ConsoleLog::open(const std::string &file_name, const bool continues) {
  sink_->open(file_name, continues);
}

std::ostream &ConsoleLog::file() { return entry_->stream; }

bool is_held_by_a_run(const std::string &file_name) {
  const int file = open(file_name.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0)
    return false;
  const bool is_held = flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(file);
  return is_held;
}

} // namespace billet
