#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <sstream>

#include "setting.h"
#include "wavetank/common/error.h"

namespace wavetank::scene {
namespace {

constexpr int greatest_depth = 32;               // a case needs 6; more is an alias that contains itself
constexpr std::size_t longest_key = 64;          // an unclosed quote makes a key of half the file
constexpr std::size_t greatest_count = 1000000;  // of settings, aliases expanded

// Length of the UTF-8 character that starts at `at`, 0 if there is none.
std::size_t character_length(const std::string& text, std::size_t at) {
  const auto byte = static_cast<unsigned char>(text[at]);
  const std::size_t length = byte < 0x80 ? 1 : (byte & 0xe0) == 0xc0 ? 2 : (byte & 0xf0) == 0xe0 ? 3 : (byte & 0xf8) == 0xf0 ? 4 : 0;
  if (at + length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((static_cast<unsigned char>(text[at + i]) & 0xc0) != 0x80) return 0;
  }
  return length;
}

void check_text(const std::string& text, const std::string& source) {
  int line = 1;
  for (std::size_t at = 0; at < text.size();) {
    const auto byte = static_cast<unsigned char>(text[at]);
    const std::size_t length = character_length(text, at);
    const bool control = byte < 0x20 && byte != '\n' && byte != '\r' && byte != '\t';
    if (length == 0 || control) {
      throw Error(source + ":" + std::to_string(line) + ": not a text file (byte " + std::to_string(byte) +
                  " is not UTF-8 text); a case is YAML text");
    }
    if (byte == '\n') ++line;
    at += length;
  }
}

class Converter {
 public:
  Converter(const std::string& source, bool has_lines) : source_(std::make_shared<const std::string>(source)), has_lines_(has_lines) {}

  Place place(int yaml_line) const { return {source_, has_lines_ ? yaml_line + 1 : 0}; }

  Setting convert(const YAML::Node& node, int depth = 0) {
    Setting setting;
    setting.place = place(node.Mark().line);
    if (depth > greatest_depth || ++count_ > greatest_count) {
      throw Error(setting.place.describe() + ": nested or repeated without end (an alias that contains itself?)");
    }
    if (node.IsScalar()) {
      setting.kind = Setting::Kind::scalar;
      setting.text = node.Scalar();
      setting.is_string = node.Tag() == "!";
    } else if (node.IsSequence()) {
      setting.kind = Setting::Kind::list;
      for (const YAML::Node& item : node) setting.items.push_back(convert(item, depth + 1));
    } else if (node.IsMap()) {
      setting.kind = Setting::Kind::map;
      for (const auto& entry : node) add_entry(setting, entry.first, entry.second, depth);
    }
    return setting;
  }

 private:
  void add_entry(Setting& map, const YAML::Node& key, const YAML::Node& value, int depth) {
    const Place key_place = place(key.Mark().line);
    if (!key.IsScalar()) throw Error(key_place.describe() + ": a key must be a single word, not a list or a map");
    if (key.Scalar().size() > longest_key || key.Scalar().find_first_of(" \t\r\n") != std::string::npos) {
      throw Error(key_place.describe() + ": a key must be a single word, not " + Setting::scalar(key.Scalar()).brief());
    }
    if (const Setting* earlier = map.find(key.Scalar())) {
      throw Error(key_place.describe() + ": " + key.Scalar() + " is given twice" +
                  (has_lines_ ? ", first on line " + std::to_string(earlier->place.line) : "") + "; give it once");
    }
    Setting converted = convert(value, depth + 1);
    converted.place = key_place;
    map.entries.emplace_back(key.Scalar(), std::move(converted));
  }

  std::shared_ptr<const std::string> source_;
  bool has_lines_;
  std::size_t count_ = 0;
};

/// Counts documents, and takes no more than one. LoadAll would find documents without end where one begins with a comma or a bracket that
/// closes: the parser takes none of them, and begins the next document there.
class DocumentCounter : public YAML::EventHandler {
 public:
  explicit DocumentCounter(const Converter& converter) : converter_(converter) {}

  int count() const { return count_; }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++count_ == 1) {
      begin_ = mark.pos;
      return;
    }
    const std::string place = converter_.place(mark.line).describe();
    if (mark.pos == begin_) throw Error(place + ": not valid YAML: nothing can begin with a comma or a closing bracket");
    throw Error(place + ": a second YAML document begins; a case is one document");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

 private:
  const Converter& converter_;
  int count_ = 0, begin_ = 0;
};

/// None is an empty text. Throws Error for more than one.
bool has_document(const std::string& yaml, const Converter& converter) {
  std::istringstream stream(yaml);
  YAML::Parser parser(stream);
  DocumentCounter documents(converter);
  while (parser.HandleNextDocument(documents)) {
  }
  return documents.count() > 0;
}

}  // namespace

Setting parse_settings(const std::string& yaml, const std::string& source) {
  check_text(yaml, source);
  const std::size_t first_line_end = yaml.find('\n');
  Converter converter(source, first_line_end != std::string::npos && first_line_end + 1 < yaml.size());
  try {
    if (!has_document(yaml, converter)) return Setting{Setting::Kind::null, "", false, {}, {}, converter.place(0)};
    return converter.convert(YAML::Load(yaml));
  } catch (const YAML::Exception& exception) {
    throw Error(converter.place(std::max(exception.mark.line, 0)).describe() + ": not valid YAML: " + exception.msg);
  }
}

}  // namespace wavetank::scene
