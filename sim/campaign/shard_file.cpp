#include "sim/campaign/shard_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "gnc/numerics/crc.hpp"
#include "sim/campaign/sequence_record.hpp"
#include "sim/host/input_file.hpp"
#include "sim/host/place.hpp"
#include "sim/host/text.hpp"
#include "sim/json/json_text.hpp"

namespace tumblesight::sim {
namespace {

using Json = nlohmann::ordered_json;

constexpr char kMagic[] = "tumblesight shard 1\n";
constexpr std::size_t kMagicBytes = sizeof kMagic - 1;
constexpr std::size_t kCrcBytes = 4;
constexpr std::size_t kMostHeaderBytes = 1 << 16;
constexpr InputKind kShardFile{"shard file",
                               std::numeric_limits<std::uint64_t>::max()};  // read record by record

std::uint32_t crc_of(const std::string& text) {
  return gnc::crc32(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

std::string header_text(const ShardHeader& header) {
  Json json{{"shard", to_string(header.shard)}, {"command", header.command}, {"commit", header.commit}};
  json["evaluation"] = to_json(header.identity);
  return json.dump();
}

std::string header_bytes(const ShardHeader& header) {
  const std::string text = header_text(header);
  const std::uint32_t crc = crc_of(text);
  std::string bytes = kMagic + text + "\n";
  bytes.append(reinterpret_cast<const char*>(&crc), kCrcBytes);
  return bytes;
}

ShardHeader header_from(const std::string& text) {
  const Json json = parse_json<Json>(text);
  return {identity_from(json.at("evaluation")), shard_from(json.at("shard").get<std::string>()),
          json.at("command").get<std::string>(), json.at("commit").get<std::string>()};
}

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw std::runtime_error(fmt::format("shard file '{}': {}", path, what));
}

// Leaves `file` behind the header.
ShardHeader read_header(const std::string& path, std::ifstream& file) {
  constexpr char kRemedy[] =
      "it is no shard file, or its beginning is damaged; shard files are made by "
      "`tumblesight evaluate --shard I/N --shard-file FILE`. Name another file, or delete this one";
  std::string magic(kMagicBytes, '\0');
  if (!file.read(magic.data(), kMagicBytes) || magic != kMagic) fail(path, kRemedy);
  std::string text;
  std::uint32_t crc = 0;
  for (char c = 0; text.size() < kMostHeaderBytes && file.get(c) && c != '\n';) text += c;
  if (!file.read(reinterpret_cast<char*>(&crc), kCrcBytes) || crc != crc_of(text)) fail(path, kRemedy);
  try {
    return header_from(text);
  } catch (const std::exception& error) {
    fail(path, fmt::format("its header is of another version of tumblesight: {}", error.what()));
  }
}

// None: there is no such file. Throws if there is one that cannot be read.
std::optional<std::ifstream> opened(const std::string& path) {
  try {
    return InputFile(path, kShardFile).stream();
  } catch (const InputRefused& refusal) {
    if (refusal.is_missing()) return std::nullopt;
    throw;
  }
}

// A pipe would keep us waiting, and a device keeps nothing.
void require_plain_file(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    fail(path, "it is no plain file; name another one");
}

// Whether a process was killed while it wrote the header: the file ends before the header does.
bool is_begun_only(const std::string& path) {
  std::ifstream file = InputFile(path, kShardFile).stream();
  std::string start(kMagicBytes + kMostHeaderBytes, '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  const std::size_t compared = std::min(start.size(), kMagicBytes);
  if (start.compare(0, compared, kMagic, compared) != 0) return false;
  const std::size_t end = start.find('\n', kMagicBytes);
  if (end == std::string::npos) return start.size() < kMagicBytes + kMostHeaderBytes;
  return start.size() < end + 1 + kCrcBytes;
}

std::vector<std::uint32_t> frames_of(const std::vector<ExperimentRun>& runs) {
  std::vector<std::uint32_t> frames;
  for (const ExperimentRun& run : runs) frames.push_back(static_cast<std::uint32_t>(run.scenario.frames));
  return frames;
}

// Record after record, until the end or something that is none.
class Records {
 public:
  Records(const std::string& path, std::vector<std::uint32_t> frames)
      : file_(InputFile(path, kShardFile).stream()), frames_(std::move(frames)) {}

  std::ifstream& file() { return file_; }
  std::uint32_t run() const { return run_of_record(bytes_.data()); }
  std::optional<SequenceResult> next() {
    bytes_.resize(sizeof(std::uint32_t));
    if (!read(0)) return std::nullopt;
    if (run() >= frames_.size()) return std::nullopt;
    bytes_.resize(record_size_bytes(frames_[run()]));
    if (!read(sizeof(std::uint32_t))) return std::nullopt;
    return from_record(bytes_.data(), frames_[run()]);
  }

 private:
  bool read(std::size_t from) {
    return static_cast<bool>(file_.read(reinterpret_cast<char*>(bytes_.data() + from),
                                        static_cast<std::streamsize>(bytes_.size() - from)));
  }

  std::ifstream file_;
  std::vector<std::uint32_t> frames_;
  std::vector<std::uint8_t> bytes_;
};

int opened_or_made(const std::string& path) {
  try {
    return open_place(Place(path), O_WRONLY | O_APPEND);
  } catch (const std::runtime_error& error) {
    fail(path, fmt::format("cannot be written: {}", error.what()));
  }
}

// An open file that no other process writes until it is closed.
int alone(const std::string& path, int file) {
  if (file < 0) fail(path, fmt::format("cannot be written: {}", std::strerror(errno)));
  if (flock(file, LOCK_EX | LOCK_NB) == 0) return file;
  const bool is_taken = errno == EWOULDBLOCK;
  const std::string reason = std::strerror(errno);
  close(file);
  if (is_taken)
    throw ShardInUse(
        fmt::format("shard file '{}': another process is writing it; wait until it ends, or end it", path));
  fail(path, reason);
}

// As long as this object lives.
class LockedFile {
 public:
  explicit LockedFile(const std::string& path) : file_(alone(path, open(path.c_str(), O_RDWR | O_CLOEXEC))) {}
  ~LockedFile() { close(file_); }
  LockedFile(const LockedFile&) = delete;
  LockedFile& operator=(const LockedFile&) = delete;
  int number() const { return file_; }

 private:
  int file_;
};

// A disk that fills up takes a part of the bytes first.
bool write_all(int file, const void* bytes, std::size_t size_bytes) {
  const auto* from = static_cast<const char*>(bytes);
  while (size_bytes > 0) {
    const ssize_t written = write(file, from, size_bytes);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    from += written;
    size_bytes -= static_cast<std::size_t>(written);
  }
  return true;
}

}  // namespace

std::string to_string(const Shard& shard) {
  return fmt::format("{}/{}", shard.index, shard.count);
}

Shard shard_from(const std::string& text) {
  const auto refuse = [&] {
    throw std::invalid_argument(fmt::format(
        "'{}' is no part I/N of the sequences: N is a whole number from 1 to {}, I from 0 to N - 1", text,
        kMostShards));
  };
  const std::size_t slash = text.find('/');
  const auto number = [&](const std::string& digits) {
    const bool is_number =
        !digits.empty() && digits.size() <= 7 &&
        std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (!is_number) refuse();
    return static_cast<std::uint32_t>(std::stoul(digits));
  };
  if (slash == std::string::npos) refuse();
  const Shard shard{number(text.substr(0, slash)), number(text.substr(slash + 1))};
  if (shard.count > kMostShards || shard.index >= shard.count) refuse();
  return shard;
}

std::vector<std::uint32_t> sequences_of(const Shard& shard, std::uint32_t sequences) {
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = shard.index; i < sequences; i += shard.count) indices.push_back(i);
  return indices;
}

ShardWriter::ShardWriter(const std::string& path, const ShardHeader& header)
    : path_(path), runs_(runs_of(header.identity.settings)), done_(runs_.size()) {
  take_file();
  try {
    if (is_begun_only(path_))
      start_file(header);
    else
      continue_file(header);
  } catch (...) {
    close(file_);
    throw;
  }
}

ShardWriter::~ShardWriter() {
  close(file_);
}

void ShardWriter::take_file() {
  const std::filesystem::path parent = std::filesystem::path(path_).parent_path();
  if (!parent.empty()) std::filesystem::create_directories(parent);
  require_plain_file(path_);
  file_ = alone(path_, opened_or_made(path_));
}

void ShardWriter::start_file(const ShardHeader& header) {
  const std::string bytes = header_bytes(header);
  if (ftruncate(file_, 0) != 0 || !write_all(file_, bytes.data(), bytes.size())) fail_to_write();
}

void ShardWriter::continue_file(const ShardHeader& header) {
  ShardContent content = read_shard(path_);
  std::string differs = difference(content.header.identity, header.identity);
  if (differs.empty() && to_string(content.header.shard) != to_string(header.shard))
    differs = fmt::format("shard is {}, not {}", to_string(content.header.shard), to_string(header.shard));
  if (differs.empty() && content.header.commit != header.commit)
    differs =
        fmt::format("it was begun by the build of commit {}, not {}", content.header.commit, header.commit);
  if (!differs.empty())
    fail(path_, fmt::format("it is of another run: {}; name another file, or delete this one", differs));
  if (ftruncate(file_, static_cast<off_t>(content.size_bytes)) != 0)
    fail(path_, fmt::format("cannot be cut to its whole records: {}", std::strerror(errno)));
  done_ = std::move(content.done);
  dropped_bytes_ = content.dropped_bytes;
}

void ShardWriter::append(std::size_t run, const SequenceResult& result) {
  const auto frames = static_cast<std::uint32_t>(runs_[run].scenario.frames);
  const std::vector<std::uint8_t> bytes = to_record(static_cast<std::uint32_t>(run), result, frames);
  if (!write_all(file_, bytes.data(), bytes.size())) fail_to_write();
}

void ShardWriter::fail_to_write() const {
  fail(path_,
       fmt::format("cannot be written: {}; free space, then run the same command again: it goes on where "
                   "it stopped",
                   std::strerror(errno)));
}

void ShardWriter::finish() {
  if (fsync(file_) != 0) fail(path_, fmt::format("cannot be written: {}", std::strerror(errno)));
}

ShardContent read_shard(const std::string& path) {
  std::ifstream probe = InputFile(path, kShardFile).stream();
  ShardContent content;
  content.header = read_header(path, probe);
  const std::vector<ExperimentRun> runs = runs_of(content.header.identity.settings);
  content.done.resize(runs.size());
  content.size_bytes = static_cast<std::uint64_t>(probe.tellg());
  const std::uint64_t file_bytes = std::filesystem::file_size(path);  // it may grow while it is read
  Records records(path, frames_of(runs));
  records.file().seekg(static_cast<std::streamoff>(content.size_bytes));
  while (const std::optional<SequenceResult> result = records.next()) {
    const Shard& shard = content.header.shard;
    const std::uint32_t sequence = result->sequence;
    if (sequence >= runs[records.run()].sequences || sequence % shard.count != shard.index)
      fail(path, fmt::format("it holds sequence {}, which is not of shard {}; delete it", sequence,
                             to_string(shard)));
    if (!content.done[records.run()].insert(sequence).second)
      fail(path,
           fmt::format("it holds sequence {} twice: two processes wrote it at the same time; delete it. "
                       "Does the file system support flock() between machines?",
                       sequence));
    content.size_bytes = static_cast<std::uint64_t>(records.file().tellg());
  }
  content.dropped_bytes = std::max(file_bytes, content.size_bytes) - content.size_bytes;
  content.is_damaged = !records.file().eof();
  return content;
}

void read_run(const std::string& path, const ShardContent& content, std::size_t run,
              const std::function<void(SequenceResult&&)>& take) {
  Records records(path, frames_of(runs_of(content.header.identity.settings)));
  (void)read_header(path, records.file());
  std::size_t left = content.done[run].size();
  while (left > 0) {
    std::optional<SequenceResult> result = records.next();
    if (!result) fail(path, "it has changed while it was read");
    if (records.run() != run) continue;
    take(std::move(*result));
    --left;
  }
}

std::optional<ShardHeader> header_of(const std::string& path) {
  std::optional<std::ifstream> file = opened(path);
  if (!file || is_begun_only(path)) return std::nullopt;
  return read_header(path, *file);
}

std::uint64_t records_in(const std::string& path) {
  std::optional<std::ifstream> file = opened(path);
  if (!file) return 0;
  try {
    const ShardHeader header = read_header(path, *file);
    const auto start_bytes = static_cast<std::uintmax_t>(file->tellg());
    std::error_code error;
    // After the header: another process may be writing it.
    const std::uintmax_t size_bytes = std::filesystem::file_size(path, error);
    if (error || size_bytes < start_bytes) return 0;
    return (size_bytes - start_bytes) / record_size_bytes(header.identity.settings.frames);
  } catch (const std::runtime_error&) {
    return 0;  // just begun, or no shard file: whoever opens it says so
  }
}

// For writing: NFS gives an exclusive lock to no other file.
bool is_in_use(const std::string& path) {
  const int file = open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (file < 0) return false;
  const bool taken = flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(file);
  return taken;
}

std::string dropped_text(const std::string& path, std::uint64_t dropped_bytes) {
  return fmt::format(
      "the last {} of '{}' begin with an incomplete or damaged record; what they held is run again",
      counted(dropped_bytes, "byte"), path);
}

std::uint64_t cut_to_whole_records(const std::string& path) {
  const LockedFile file(path);
  const ShardContent content = read_shard(path);
  if (content.dropped_bytes > 0 && ftruncate(file.number(), static_cast<off_t>(content.size_bytes)) != 0)
    fail(path, fmt::format("cannot be cut to its whole records: {}", std::strerror(errno)));
  return content.dropped_bytes;
}

}  // namespace tumblesight::sim
