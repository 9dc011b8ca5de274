#include "segmenter_segnet/text_node.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <iterator>

#include "stillpoint/error.hpp"
#include "stillpoint/support/input_file.hpp"

namespace stillpoint::segmenter_segnet {
namespace {

constexpr int kMaxDepth = 100;  // nested messages; Caffe's have five

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.' || c == '-' ||
         c == '+' || c == '/';
}

class TextParser {
 public:
  TextParser(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  TextNode parse() {
    TextNode root{.is_message = true, .where = file_};
    parse_fields(root, '\0', 0);
    return root;
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(Fault::kData, problem, where(), "is it the network's .prototxt?");
  }
  std::string where() const { return file_ + ":" + std::to_string(line_); }

  /// The next character that is neither space nor comment, or 0 at the end.
  char peek() {
    for (; position_ < text_.size(); ++position_) {
      const char c = text_[position_];
      if (c == '\n') ++line_;
      if (c == '#')
        position_ = std::min(text_.find('\n', position_), text_.size()) - 1;
      else if (!std::isspace(static_cast<unsigned char>(c)))
        return c;
    }
    return '\0';
  }
  bool skip(char c) {
    if (peek() != c || c == '\0') return false;
    ++position_;
    return true;
  }

  void parse_fields(TextNode& message, char end, int depth) {
    if (depth > kMaxDepth) fail("the messages are nested too deeply");
    while (peek() != end) {
      if (peek() == '\0') fail("the text ends inside '" + message.name + "'");
      parse_field(message, depth);
      if (!skip(',')) skip(';');
    }
  }

  void parse_field(TextNode& message, int depth) {
    const std::string name = word();
    if (name.empty()) fail("expected the name of a field");
    const bool colon = skip(':');
    if (colon && skip('[')) {
      while (!skip(']')) {
        parse_value(message, name, depth);
        if (peek() == '\0') fail("the list of '" + name + "' does not end");
        skip(',');
      }
    } else if (colon || peek() == '{' || peek() == '<') {
      parse_value(message, name, depth);
    } else {
      fail("expected ':' or '{' after '" + name + "'");
    }
  }

  void parse_value(TextNode& message, const std::string& name, int depth) {
    TextNode node{.name = name};
    const char first = peek();
    node.where = where();
    if (first == '{' || first == '<') {
      ++position_;
      node.is_message = true;
      parse_fields(node, first == '{' ? '}' : '>', depth + 1);
      ++position_;
    } else if (first == '"' || first == '\'') {
      while (peek() == '"' || peek() == '\'') node.value += quoted();
    } else {
      node.value = word();
      if (node.value.empty()) fail("expected a value for '" + name + "'");
    }
    message.fields.push_back(std::move(node));
  }

  std::string word() {
    peek();
    const std::size_t start = position_;
    while (position_ < text_.size() && is_word(text_[position_])) ++position_;
    return std::string(text_.substr(start, position_ - start));
  }

  std::string quoted() {
    const char quote = text_[position_++];
    std::string result;
    for (; position_ < text_.size() && text_[position_] != '\n'; ++position_) {
      if (text_[position_] == quote) return ++position_, result;
      if (text_[position_] == '\\' && position_ + 1 < text_.size()) ++position_;
      result += text_[position_];
    }
    fail("a string does not end");
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t position_ = 0;
  int line_ = 1;
};

}  // namespace

const TextNode* TextNode::find(std::string_view field) const {
  const auto found = std::find_if(fields.rbegin(), fields.rend(),
                                  [&](const TextNode& node) { return node.name == field; });
  return found == fields.rend() ? nullptr : &*found;
}

std::vector<const TextNode*> TextNode::all(std::string_view field) const {
  std::vector<const TextNode*> found;
  for (const TextNode& node : fields)
    if (node.name == field) found.push_back(&node);
  return found;
}

std::string TextNode::text(std::string_view field, const std::string& fallback) const {
  const TextNode* node = find(field);
  return node ? node->value : fallback;
}

int TextNode::as_integer() const {
  int number = 0;
  const char* end = value.data() + value.size();
  const auto [stop, fault] = std::from_chars(value.data(), end, number);
  if (fault != std::errc() || stop != end)
    throw Error(Fault::kData, "'" + name + "' must be an integer, not '" + value + "'", where);
  return number;
}

int TextNode::integer(std::string_view field, int fallback) const {
  const TextNode* node = find(field);
  return node ? node->as_integer() : fallback;
}

bool TextNode::boolean(std::string_view field, bool fallback) const {
  const TextNode* node = find(field);
  if (!node) return fallback;
  if (node->value == "true" || node->value == "1") return true;
  if (node->value == "false" || node->value == "0") return false;
  throw Error(Fault::kData, "'" + node->name + "' must be true or false, not '" + node->value + "'",
              node->where);
}

TextNode read_text_file(const std::filesystem::path& file) {
  const std::string text = read_input_file(file);
  if (text.find('\0') != std::string::npos)
    throw Error(Fault::kData, "is not a text file", file.string(),
                "are 'prototxt' and 'model' swapped?");
  return parse_text(text, file.string());
}

TextNode parse_text(std::string_view text, const std::string& file) {
  return TextParser(text, file).parse();
}

}  // namespace stillpoint::segmenter_segnet
