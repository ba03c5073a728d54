#include "mien/report/detail/html.h"

#include <fmt/format.h>

#include <cstdint>

namespace mien::detail {
namespace {

/// The length of the UTF-8 sequence at `text[i]`, 0 where there is none.
std::size_t sequence_length(std::string_view text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned char first = byte(i);
  const std::size_t length = first < 0x80                    ? 1
                             : first >= 0xC2 && first < 0xE0 ? 2
                             : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xF0 && first < 0xF5 ? 4
                                                             : 0;
  if (length == 0 || i + length > text.size()) return 0;
  for (std::size_t k = 1; k < length; ++k)
    if ((byte(i + k) & 0xC0) != 0x80) return 0;
  if (first == 0xE0 && byte(i + 1) < 0xA0) return 0;
  if (first == 0xED && byte(i + 1) >= 0xA0) return 0;
  if (first == 0xF0 && byte(i + 1) < 0x90) return 0;
  if (first == 0xF4 && byte(i + 1) >= 0x90) return 0;
  return length;
}

void append_escaped(std::string& safe, std::string_view sequence) {
  const char c = sequence.front();
  if (sequence.size() > 1)
    safe += sequence;
  else if (c == '&')
    safe += "&amp;";
  else if (c == '<')
    safe += "&lt;";
  else if (c == '>')
    safe += "&gt;";
  else if (c == '"')
    safe += "&quot;";
  else if (c == '\'')
    safe += "&#39;";
  else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F)
    safe += c == '\n' || c == '\t' ? " " : "\xEF\xBF\xBD";
  else
    safe += c;
}

constexpr std::string_view style = R"(
:root{color-scheme:light dark;--paper:#fbfbfa;--card:#fff;--ink:#1d1f22;--soft:#5c6168;--line:#dcdee1;--mark:#b3261e;--ground:#edeef0}
@media (prefers-color-scheme:dark){:root{--paper:#17181a;--card:#202225;--ink:#e8e9eb;--soft:#a2a7ae;--line:#383b40;--mark:#ff8a80;--ground:#2a2d31}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,"DejaVu Sans",sans-serif}
main{max-width:1180px;margin:0 auto;padding:24px 16px 64px}
h1{font-size:1.7rem;line-height:1.2;margin:.2em 0 .1em;overflow-wrap:anywhere}
h2{font-size:1.25rem;margin:2.4em 0 .3em;padding-top:.6em;border-top:1px solid var(--line)}
h3{font-size:1rem;margin:1.6em 0 .4em}
p{max-width:72ch;margin:.4em 0 1em}
.soft,figcaption{color:var(--soft)}
.bad{color:var(--mark);font-weight:600}
nav{display:flex;flex-wrap:wrap;gap:4px 14px;margin:14px 0;font-size:.92rem}
a{color:inherit;text-underline-offset:3px}
dl.facts{display:grid;grid-template-columns:repeat(auto-fill,minmax(150px,1fr));gap:10px;margin:18px 0}
dl.facts div{background:var(--card);border:1px solid var(--line);border-radius:8px;padding:8px 12px}
dl.facts dt{font-size:.8rem;color:var(--soft)}
dl.facts dd{margin:0;font-size:1.15rem;font-variant-numeric:tabular-nums;overflow-wrap:anywhere}
ul.warnings{list-style:none;padding:0;margin:18px 0}
ul.warnings li{background:var(--card);border:1px solid var(--line);border-left:4px solid var(--mark);border-radius:4px;padding:8px 12px;margin:8px 0}
ul.warnings span{display:block;color:var(--soft)}
figure{margin:0}
figure img{display:block;width:100%;height:auto;border-radius:6px;background:var(--ground)}
figcaption{font-size:.85rem;padding:4px 2px;overflow-wrap:anywhere}
figcaption b{color:var(--ink)}
.three{display:grid;grid-template-columns:repeat(3,1fr);gap:10px;margin:12px 0}
.maps{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,300px),1fr));gap:12px;margin:12px 0}
.cards{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,330px),1fr));gap:12px;margin:12px 0}
.card{background:var(--card);border:1px solid var(--line);border-radius:8px;padding:6px}
.pair{display:grid;grid-template-columns:1fr 1fr;gap:4px}
.pair img{display:block;width:100%;height:auto;border-radius:5px;background:var(--ground)}
.card h4{font-size:.9rem;margin:4px 2px;overflow-wrap:anywhere}
.card p{font-size:.8rem;margin:2px;color:var(--soft);font-variant-numeric:tabular-nums}
.scroll{overflow-x:auto}
table{border-collapse:collapse;font-size:.86rem;font-variant-numeric:tabular-nums;margin:8px 0}
th,td{padding:4px 8px;border-bottom:1px solid var(--line);text-align:right;white-space:nowrap}
th:first-child,td:first-child{text-align:left}
.text th,.text td{text-align:left}
thead th{font-weight:600;color:var(--soft);vertical-align:bottom}
.plots{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,480px),1fr));gap:12px}
.plot{background:#fff;border:1px solid var(--line);border-radius:8px;padding:6px}
.plot svg{display:block;max-width:100%;height:auto;margin:0 auto}
details{margin:12px 0}summary{cursor:pointer}
footer{margin-top:48px;color:var(--soft);font-size:.85rem}
@media (max-width:560px){.three{gap:4px}figcaption{font-size:.75rem}.cards{grid-template-columns:1fr}}
)";

}  // namespace

std::string escaped(std::string_view text) {
  std::string safe;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = sequence_length(text, i);
    if (length == 0) {
      safe += "\xEF\xBF\xBD";
      ++i;
    } else {
      append_escaped(safe, text.substr(i, length));
      i += length;
    }
  }
  return safe;
}

std::string base64(const std::vector<unsigned char>& bytes) {
  static constexpr std::string_view letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < left ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= left ? letters[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string image(const Picture& picture, std::string_view alt) {
  return fmt::format(
      R"(<img loading="lazy" decoding="async" width="{}" height="{}" alt="{}" src="data:image/png;base64,{}">)",
      picture.width, picture.height, escaped(alt), base64(encode_png(picture)));
}

std::string figure(const Picture& picture, std::string_view alt, const std::string& caption) {
  return "<figure>" + image(picture, alt) + "<figcaption>" + caption + "</figcaption></figure>\n";
}

std::string table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows) {
  std::string text = "<div class=\"scroll\"><table><thead><tr>";
  for (const std::string& cell : head) text += "<th scope=\"col\">" + cell + "</th>";
  text += "</tr></thead><tbody>\n";
  for (const auto& row : rows) {
    text += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c)
      text += (c == 0 ? "<th scope=\"row\">" : "<td>") + row[c] + (c == 0 ? "</th>" : "</td>");
    text += "</tr>\n";
  }
  return text + "</tbody></table></div>\n";
}

std::string document(std::string_view title, const std::string& body) {
  std::string page =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>";
  page += escaped(title);
  page += "</title><style>";
  page += style;
  page += "</style></head><body><main>\n";
  page += body;
  return page + "</main></body></html>\n";
}

}  // namespace mien::detail
