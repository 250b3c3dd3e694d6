//! A page to keep: the answer first, pictures inside, what it rests on and where it comes from. One file that needs no other,
//! for a screen and for A4.

/// A page.
#[derive(Debug, Clone, Default)]
pub struct Page {
    /// What it is about.
    pub title: String,
    /// The answer.
    pub answer: Vec<String>,
    /// What the user says of ball, surface and day.
    pub note: Option<String>,
    /// What follows, in this order.
    pub sections: Vec<Section>,
}

/// A part of a page under its heading.
#[derive(Debug, Clone)]
pub struct Section {
    /// Its heading.
    pub heading: String,
    /// What it holds.
    pub content: Content,
}

/// What a section holds.
#[derive(Debug, Clone)]
pub enum Content {
    /// Text whose lines and columns stay as they are.
    Text(String),
    /// Pictures in SVG.
    Pictures(Vec<String>),
    /// Names and values.
    Table(Vec<(String, String)>),
}

const STYLE: &str = "@page{size:A4;margin:15mm}\
body{font:11pt/1.4 'DejaVu Sans',Verdana,sans-serif;color:#1a1a1a;max-width:180mm;margin:8mm auto;padding:0 4mm}\
h1{font-size:15pt;margin:0 0 4mm;overflow-wrap:anywhere}h2{font-size:12pt;margin:7mm 0 2mm;break-after:avoid}\
.answer{font-size:12pt;font-weight:bold;margin:0 0 2mm;overflow-wrap:anywhere}.note{margin:0 0 2mm;white-space:pre-wrap}\
pre{font:8.5pt/1.35 'DejaVu Sans Mono',monospace;white-space:pre-wrap;overflow-wrap:anywhere;margin:0}\
svg{display:block;width:100%;height:auto;max-height:250mm;break-inside:avoid;margin:0 0 3mm}\
table{border-collapse:collapse;font-size:9.5pt;width:100%}th,td{text-align:left;vertical-align:top;padding:1mm 3mm 1mm 0;\
border-bottom:0.2mm solid #bbb;overflow-wrap:anywhere}th{width:35%;font-weight:normal;color:#555}";

/// The file.
#[must_use]
pub fn to_html(page: &Page) -> String {
    let title = escaped(&page.title);
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>{title}</title>\n<style>{STYLE}</style>\n\
         </head>\n<body>\n<h1>{title}</h1>\n"
    );
    for line in &page.answer {
        out += &format!("<p class=\"answer\">{}</p>\n", escaped(line));
    }
    if let Some(note) = &page.note {
        out += &format!("<p class=\"note\">{}</p>\n", escaped(note));
    }
    for Section { heading, content } in &page.sections {
        out += &format!("<h2>{}</h2>\n{}", escaped(heading), body(content));
    }
    out + "</body>\n</html>\n"
}

fn body(content: &Content) -> String {
    match content {
        Content::Text(text) => format!("<pre>{}</pre>\n", escaped(text.trim_end())),
        Content::Pictures(pictures) => pictures
            .iter()
            .map(|svg| svg.trim_end().to_owned() + "\n")
            .collect(),
        Content::Table(rows) => {
            let row = |(name, value): &(String, String)| {
                format!(
                    "<tr><th>{}</th><td>{}</td></tr>\n",
                    escaped(name),
                    escaped(value)
                )
            };
            let rows: String = rows.iter().map(row).collect();
            format!("<table>\n{rows}</table>\n")
        }
    }
}

/// Text that cannot become a part of the page's form.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            c if c.is_control() && c != '\n' => out += &c.escape_default().to_string(),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_has_the_answer_first_and_nothing_from_outside_as_markup() {
        let page = Page {
            title: "<b>.wav".to_owned(),
            answer: vec!["e = 0.93 & more".to_owned()],
            note: Some("steel\n\"plate\"\u{1b}".to_owned()),
            sections: vec![
                Section {
                    heading: "Pictures".to_owned(),
                    content: Content::Pictures(vec![
                        "<svg viewBox=\"0 0 14 7\"><g/></svg>\n".to_owned(),
                    ]),
                },
                Section {
                    heading: "Words".to_owned(),
                    content: Content::Text("a  b\n<i>\n".to_owned()),
                },
                Section {
                    heading: "Settings".to_owned(),
                    content: Content::Table(vec![("height".to_owned(), "1 m".to_owned())]),
                },
            ],
        };
        let html = to_html(&page);
        assert!(
            html.contains("<h1>&lt;b&gt;.wav</h1>\n<p class=\"answer\">e = 0.93 &amp; more</p>"),
            "{html}"
        );
        assert!(
            html.contains("steel\n&quot;plate&quot;\\u{1b}")
                && html.contains("<pre>a  b\n&lt;i&gt;</pre>"),
            "{html}"
        );
        assert!(html.contains("viewBox=\"0 0 14 7\"><g/></svg>"), "{html}");
        assert!(
            html.contains("<tr><th>height</th><td>1 m</td></tr>"),
            "{html}"
        );
        let places = ["0.93", "steel", "<svg", "<i", "1 m"]
            .map(|part| html.find(part).unwrap_or(usize::MAX));
        assert!(
            places[0] < places[1] && places[1] < places[2] && places[2] < places[4],
            "{html}"
        );
        for outside in ["http:", "https:", "<script", "<link", "src="] {
            assert!(!html.contains(outside), "{outside}");
        }
    }
}
