//! What self-contained HTML reports share: one look for light and dark, phone and desktop, keyboard and
//! colour-blind readers; nothing is loaded from anywhere.

/// Colours follow the reader's light or dark setting. Curves are Okabe and Ito's blue and vermilion (in the
/// dark their sky blue and orange), which colour-blind people tell apart; dashes tell them apart without
/// any colour.
const STYLE: &str = "\
:root{color-scheme:light dark;--ground:#fff;--ink:#1c1f23;--faint:#5a636c;--rule:#d0d5da;--soft:#eef3f7;\
--blue:#0072b2;--red:#d55e00;--yes:#d8f0e0;--no:#fbe0d3}\
@media(prefers-color-scheme:dark){:root{--ground:#14171a;--ink:#e6e9ec;--faint:#a3adb6;--rule:#3b434b;\
--soft:#1f262c;--blue:#56b4e9;--red:#e69f00;--yes:#153f28;--no:#56260f}}\
body{font:16px/1.5 system-ui,sans-serif;max-width:1160px;margin:1.5em auto;padding:0 1em;\
background:var(--ground);color:var(--ink)}\
h1{font-size:1.5em;line-height:1.25}h2{font-size:1.15em;margin-top:2em;border-bottom:1px solid var(--rule)}\
.verdict{font-size:1.15em;background:var(--soft);border-left:5px solid var(--blue);padding:.7em 1em}\
table{border-collapse:collapse;font-size:14px;margin:.6em 0}\
td,th{padding:3px 8px;border:1px solid var(--rule);text-align:right}\
th,td:first-child{text-align:left}td.words{text-align:left}\
.wide{overflow-x:auto}.wide td:first-child,.wide th:first-child{position:sticky;left:0;background:var(--ground)}.wide:focus-visible,summary:focus-visible{outline:3px solid var(--blue);outline-offset:2px}\
.note{color:var(--faint);font-size:14px}.row{display:flex;flex-wrap:wrap;gap:8px}details{margin:.4em 0}\
summary{cursor:pointer}pre{overflow-x:auto;font-size:13px}pre.notes{font:inherit;white-space:pre-wrap}\
.yes{background:var(--yes)}.no{background:var(--no)}figure{margin:1em 0}\
figure svg{display:block;width:100%;min-width:860px;height:auto;background:#fff;border-radius:4px}\
.row svg{flex:1 1 300px;max-width:385px;height:auto}\
.row svg text{font:11px system-ui,sans-serif;fill:var(--ink)}svg .t{font-weight:600}\
.frame{fill:none;stroke:var(--faint)}.grid{stroke:var(--rule);stroke-width:.6}\
.l0,.l1,.l2{fill:none;stroke-width:1.2;stroke-linejoin:round}.l0{stroke:var(--ink)}\
.l1{stroke:var(--red);stroke-dasharray:5 2}.l2{stroke:var(--blue)}.key{vertical-align:middle}\
.bars{width:100%;max-width:760px}.bars td,.bars th{border:0;padding:2px 6px}\
.bars th{font-weight:400;width:11.5em;text-align:right;overflow-wrap:anywhere}.bars td{text-align:left}\
.bar{display:inline-block;height:.95em;background:var(--blue);vertical-align:-.12em;margin-right:.5em}\
@media(max-width:600px){body{font-size:15px}.bars th{width:8em}td,th{padding:3px 5px}}";

/// Everything up to the page's heading.
pub fn head(title: &str) -> String {
    let title = escape(title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\
         <title>{title}</title><style>{STYLE}</style></head>\n<body><main><h1>{title}</h1>\n"
    )
}

/// What ends the page.
pub const TAIL: &str = "</main></body></html>\n";

/// Something wider than a phone: scrolls by finger, mouse and arrow keys; `name` is for screen readers.
pub fn wide(name: &str, inner: &str) -> String {
    format!(
        "<div class=\"wide\" role=\"region\" tabindex=\"0\" aria-label=\"{}\">{inner}</div>\n",
        escape(name)
    )
}

/// The first row of a table.
pub fn columns(names: &[&str]) -> String {
    let cells: String =
        names.iter().map(|name| format!("<th scope=\"col\">{}</th>", escape(name))).collect();
    format!("<tr>{cells}</tr>\n")
}

/// A picture with what a screen reader says of it.
pub fn picture(svg: &str, name: &str) -> String {
    svg.replacen("<svg ", &format!("<svg role=\"img\" aria-label=\"{}\" ", escape(name)), 1)
}

/// Text as HTML.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_names_its_language_follows_the_dark_and_loads_nothing() {
        let page = head("Gap & more") + TAIL;
        for part in
            ["<html lang=\"en\">", "<title>Gap &amp; more</title>", "prefers-color-scheme:dark"]
        {
            assert!(page.contains(part), "{part}");
        }
        for part in ["http", "url(", "src=", "@import"] {
            assert!(!page.contains(part), "{part}");
        }
    }

    #[test]
    fn a_picture_is_named_for_screen_readers() {
        let told = picture("<svg width=\"1\"><path/></svg>", "a < b");
        assert_eq!(told, "<svg role=\"img\" aria-label=\"a &lt; b\" width=\"1\"><path/></svg>");
    }
}
