#include "collada_checks.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr std::size_t deepest = 500;  // elements in each other

std::string plain_name(const std::string& name) { return name.size() <= 40 ? name : name.substr(0, 40) + "…"; }

/// A tag of an XML text.
struct XmlTag {
  std::string name;
  std::map<std::string, std::string> attributes;
  bool begins = false, ends = false;  ///< both: an element without content
  int line = 1;
  std::size_t end = 0;  ///< of the tag, in the text

  std::string attribute(const std::string& key) const {
    const auto found = attributes.find(key);
    return found == attributes.end() ? "" : found->second;
  }
};

/// Goes from tag to tag, past comments, declarations and what is quoted.
class XmlTags {
 public:
  explicit XmlTags(const std::string& text) : text_(text) {}

  std::optional<XmlTag> next() {
    while (true) {
      const std::size_t begin = text_.find('<', at_);
      if (begin == std::string::npos) return std::nullopt;
      go_to(begin);
      if (starts("<!--"))
        go_behind("-->");
      else if (starts("<![CDATA["))
        go_behind("]]>");
      else if (starts("<?"))
        go_behind("?>");
      else if (starts("<!"))
        go_behind(">");
      else
        return tag();
    }
  }

 private:
  bool starts(const char* word) const { return text_.compare(at_, std::char_traits<char>::length(word), word) == 0; }

  void go_to(std::size_t place) {
    place = std::min(place, text_.size());
    line_ += static_cast<int>(
        std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_), text_.begin() + static_cast<std::ptrdiff_t>(place), '\n'));
    at_ = place;
  }

  void go_behind(const char* word) {
    const std::size_t found = text_.find(word, at_);
    go_to(found == std::string::npos ? text_.size() : found + std::char_traits<char>::length(word));
  }

  void skip_blanks(std::size_t& at) const {
    while (at < text_.size() && std::isspace(static_cast<unsigned char>(text_[at])) != 0) ++at;
  }

  std::string name_at(std::size_t& at) const {
    const std::size_t begin = at;
    while (at < text_.size() && std::isspace(static_cast<unsigned char>(text_[at])) == 0 &&
           std::string("=/><\"'").find(text_[at]) == std::string::npos)
      ++at;
    return text_.substr(begin, at - begin);
  }

  XmlTag tag() {
    XmlTag tag;
    tag.line = line_;
    std::size_t at = at_ + 1;
    tag.ends = at < text_.size() && text_[at] == '/';
    tag.begins = !tag.ends;
    if (tag.ends) ++at;
    tag.name = name_at(at);
    while (at < text_.size() && text_[at] != '>') {
      skip_blanks(at);
      const std::string key = name_at(at);
      skip_blanks(at);
      if (at < text_.size() && text_[at] == '=') {
        skip_blanks(++at);
        if (at >= text_.size() || (text_[at] != '"' && text_[at] != '\'')) continue;
        const std::size_t end = text_.find(text_[at], at + 1);
        if (end == std::string::npos) break;
        tag.attributes[key] = text_.substr(at + 1, end - at - 1);
        at = end + 1;
      } else if (at < text_.size() && text_[at] == '/') {
        tag.ends = true;
        ++at;
      } else if (key.empty() && at < text_.size() && text_[at] != '>') {
        ++at;  // no XML, which assimp tells of
      }
    }
    go_to(at + 1);
    tag.end = at_;
    return tag;
  }

  const std::string& text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

class ColladaCheck {
 public:
  ColladaCheck(const std::string& path, const std::string& text) : path_(path), text_(text) {}

  void check() {
    XmlTags tags(text_);
    while (const std::optional<XmlTag> tag = tags.next()) {
      if (tag->begins) begin(*tag);
      if (tag->ends) end(*tag);
    }
    for (const Accessor& accessor : accessors_) check_accessor(accessor);
    for (std::size_t node = 0; node < nodes_.size(); ++node) check_depth(node, 0, nodes_[node].line);
  }

 private:
  struct Accessor {
    XmlTag tag;
    std::size_t parameters = 0;
  };

  struct Node {
    std::string id, name;
    int line = 1;
    std::vector<std::size_t> within;                     ///< that are written in it
    std::vector<std::pair<std::string, int>> instances;  ///< the addresses of others that it holds, and the lines where
    std::size_t depth = 0;                               ///< in nodes, with what it holds; 0: not known yet
    bool is_under_way = false;
  };

  void begin(const XmlTag& tag) {
    if (tag.name == "param" && !accessors_.empty() && !open_.empty() && open_.back().name == "accessor") ++accessors_.back().parameters;
    if (tag.name == "node") add_node(tag);
    if (!tag.ends) open_.push_back(tag);
    if (open_.size() > deepest) fail(tag.line, "more than " + std::to_string(deepest) + " elements are nested there");
    if (tag.name == "float_array") check_array(tag);
    if (tag.name == "p" || tag.name == "vcount") check_indices(tag);
    if (tag.name == "accessor") accessors_.push_back({tag, 0});
    if (tag.name == "instance_node") note_instance(tag);
  }

  void end(const XmlTag& tag) {
    if (tag.begins) return;  // it was never opened
    if (open_.empty() || open_.back().name != tag.name) return;
    open_.pop_back();
    if (tag.name == "node") open_nodes_.pop_back();
  }

  /// The words of an element's text.
  template <class Visit>
  void visit_words(const XmlTag& tag, const Visit& visit) const {
    if (tag.ends) return;
    const std::size_t end = std::min(text_.find('<', tag.end), text_.size());
    int line = tag.line;
    for (std::size_t at = tag.end; at < end;) {
      if (std::isspace(static_cast<unsigned char>(text_[at])) != 0) {
        if (text_[at++] == '\n') ++line;
        continue;
      }
      const std::size_t begin = at;
      while (at < end && std::isspace(static_cast<unsigned char>(text_[at])) == 0) ++at;
      visit(begin, at - begin, line);
    }
  }

  double whole_number(const XmlTag& tag, const std::string& key, const std::string& usual) const {
    const std::string text = tag.attributes.count(key) != 0 ? tag.attribute(key) : usual;
    const bool digits = !text.empty() && text.size() < 16 && text.find_first_not_of("0123456789") == std::string::npos;
    if (!digits) fail(tag.line, tag.name + " has the " + key + " '" + plain_name(text) + "'; it must be a whole number");
    return std::stod(text);
  }

  void check_array(const XmlTag& tag) {
    const double announced = whole_number(tag, "count", "");
    std::size_t words = 0;
    visit_words(tag, [&](std::size_t, std::size_t, int) { ++words; });
    if (static_cast<double>(words) != announced)
      fail(tag.line, "float_array '" + plain_name(tag.attribute("id")) + "' has " + std::to_string(words) + " numbers, but its count is " +
                         plain_name(tag.attribute("count")) + "; they must be the same");
    if (!tag.attribute("id").empty()) arrays_[tag.attribute("id")] = announced;
  }

  void check_indices(const XmlTag& tag) const {
    visit_words(tag, [&](std::size_t begin, std::size_t length, int line) {
      const bool digits = length < 10 && std::all_of(text_.begin() + static_cast<std::ptrdiff_t>(begin),
                                                     text_.begin() + static_cast<std::ptrdiff_t>(begin + length),
                                                     [](char c) { return c >= '0' && c <= '9'; });
      if (!digits)
        fail(line, tag.name + " has '" + plain_name(text_.substr(begin, length)) + "' where a whole number from 0 on must stand");
    });
  }

  void check_accessor(const Accessor& accessor) const {
    const XmlTag& tag = accessor.tag;
    const double count = whole_number(tag, "count", "0"), stride = whole_number(tag, "stride", "1"),
                 offset = whole_number(tag, "offset", "0");
    if (stride < 1) fail(tag.line, "an accessor has the stride 0; it must be at least 1");
    const std::string source = tag.attribute("source");
    const auto array = arrays_.find(source.empty() ? source : source.substr(1));
    if (array == arrays_.end() || count == 0) return;
    const double last = std::clamp(static_cast<double>(accessor.parameters), 1.0, stride);
    if (offset + (count - 1) * stride + last > array->second)
      fail(tag.line, "an accessor reads " + plain_name(tag.attribute("count")) + " times " +
                         plain_name(tag.attributes.count("stride") != 0 ? tag.attribute("stride") : "1") + " numbers of '" +
                         plain_name(source) + "', which has " + std::to_string(static_cast<long long>(array->second)));
  }

  void add_node(const XmlTag& tag) {
    const std::size_t node = nodes_.size();
    nodes_.push_back({tag.attribute("id"), tag.attribute("name"), tag.line, {}, {}});
    if (!open_nodes_.empty()) nodes_[open_nodes_.back()].within.push_back(node);
    if (!tag.ends) open_nodes_.push_back(node);
    // an address means an id; assimp looks for it among the nodes of the library first, and takes a name where no node has that id
    const bool is_of_library = !open_.empty() && open_.back().name == "library_nodes";
    if (is_of_library)
      by_id_[nodes_[node].id] = node;
    else
      by_id_.emplace(nodes_[node].id, node);
    by_name_.emplace(nodes_[node].name, node);
  }

  void note_instance(const XmlTag& tag) {
    const std::string url = tag.attribute("url");
    if (url.size() >= 2 && !open_nodes_.empty()) nodes_[open_nodes_.back()].instances.emplace_back(url.substr(1), tag.line);
  }

  std::optional<std::size_t> node_at(const std::string& address) const {
    for (const auto* names : {&by_id_, &by_name_})
      if (const auto found = names->find(address); found != names->end()) return found->second;
    return std::nullopt;
  }

  /// How many nodes deep this one is. `above`: how many hold it by now, the last in this line.
  std::size_t check_depth(std::size_t which, std::size_t above, int line) {
    Node& node = nodes_[which];
    if (node.is_under_way) fail(line, "node '" + plain_name(node.id.empty() ? node.name : node.id) + "' holds itself");
    if (above + std::max<std::size_t>(node.depth, 1) > deepest)
      fail(line, "nodes hold each other more than " + std::to_string(deepest) + " deep");
    if (node.depth > 0) return node.depth;
    node.is_under_way = true;
    std::size_t below = 0;
    for (const std::size_t held : node.within) below = std::max(below, check_depth(held, above + 1, nodes_[held].line));
    for (const auto& [address, where] : node.instances)
      if (const std::optional<std::size_t> held = node_at(address)) below = std::max(below, check_depth(*held, above + 1, where));
    node.is_under_way = false;
    return node.depth = below + 1;
  }

  [[noreturn]] void fail(int line, const std::string& why) const {
    throw Error("mesh file '" + path_ + "' is damaged: line " + std::to_string(line) + ": " + why);
  }

  const std::string& path_;
  const std::string& text_;
  std::vector<XmlTag> open_;
  std::map<std::string, double> arrays_;  ///< how many numbers each has
  std::vector<Accessor> accessors_;
  std::vector<Node> nodes_;
  std::vector<std::size_t> open_nodes_;
  std::map<std::string, std::size_t> by_id_, by_name_;
};

}  // namespace

bool is_collada(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  const auto small = [](std::string& text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  };
  small(extension);
  if (extension == ".dae" || extension == ".zae") return true;
  std::ifstream file(path, std::ios::binary);
  std::string head(4096, ' ');  // assimp looks less far
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.erase(std::remove(head.begin(), head.end(), '\0'), head.end());  // of UTF-16, which assimp takes too
  small(head);
  return head.find("<collada") != std::string::npos;
}

void check_collada(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const std::string unreadable = "mesh file '" + path + "' cannot be read";
  if (!file) throw Error(unreadable);
  if (text.compare(0, 2, "PK") == 0)
    throw Error(unreadable + ": it is a compressed Collada file; unpack it and give the .dae that is in it");
  if (text.compare(0, 2, "\xff\xfe") == 0 || text.compare(0, 2, "\xfe\xff") == 0 || text.find('\0') != std::string::npos)
    throw Error(unreadable + ": its characters are not of one byte each (UTF-16, say); save it as UTF-8");
  ColladaCheck(path, text).check();
}

}  // namespace wavetank
