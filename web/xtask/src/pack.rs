//! The parts of the page as files to be served, and as one file.

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::io::Write;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use sha2::{Digest, Sha256};

use crate::scripts::script;

/// Where the page names what stands in files of its own.
const STYLE: &str = "<link rel=\"stylesheet\" href=\"style.css\">";
const SCRIPT: &str = "<script src=\"app.js\" defer></script>";
const LINKS: [&str; 2] = [
    "<link rel=\"manifest\" href=\"manifest.webmanifest\">\n",
    "<link rel=\"icon\" href=\"icon.svg\">\n",
];
/// The policy of the page that is served: nothing from elsewhere.
const POLICY: &str = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; \
    img-src 'self' blob:; worker-src 'self'; connect-src 'self'; manifest-src 'self'; base-uri 'none'; \
    form-action 'none'";

/// All that the page is made of.
#[derive(Debug)]
pub(crate) struct Parts {
    /// Names and contents as they are served, but for the library.
    files: BTreeMap<&'static str, String>,
    wasm: Vec<u8>,
}

impl Parts {
    pub(crate) fn read(page: &Path, glue: &str, wasm: Vec<u8>) -> Result<Self, Box<dyn Error>> {
        let text = |name: &str| {
            let path = page.join(name);
            fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))
        };
        let mut files = BTreeMap::new();
        for name in [
            "index.html",
            "style.css",
            "manifest.webmanifest",
            "icon.svg",
            "recorder.js",
            "offline.js",
        ] {
            files.insert(name, text(name)?);
        }
        let worker = script(page, "worker.js")?;
        files.insert("worker.js", without_comments(&format!("{glue}\n{worker}")));
        files.insert("app.js", without_comments(&script(page, "app.js")?));
        Ok(Self { files, wasm })
    }

    fn file(&self, name: &str) -> Result<&str, String> {
        let file = self.files.get(name);
        file.map(String::as_str).ok_or_else(|| format!("no {name}"))
    }

    /// Writes the files that a server gives.
    pub(crate) fn write_files(&self, dist: &Path) -> Result<(), Box<dyn Error>> {
        let page = with_policy(self.file("index.html")?, POLICY)?;
        let mut all = Sha256::new_with_prefix(&self.wasm);
        self.files.values().for_each(|text| all.update(text));
        let version = STANDARD.encode(all.finalize());
        for (name, text) in &self.files {
            let text = match *name {
                "index.html" => page.clone(),
                "offline.js" => text.replace("VERSION", &version),
                _ => text.clone(),
            };
            fs::write(dist.join(name), text)?;
        }
        fs::write(dist.join("library.wasm"), &self.wasm)?;
        Ok(())
    }

    /// Writes the page as one file, which needs no server.
    pub(crate) fn write_one(&self, path: &Path) -> Result<(), Box<dyn Error>> {
        let style = self.file("style.css")?;
        let mut script = String::new();
        for (name, text) in [
            ("WORKER", self.file("worker.js")?.as_bytes().to_vec()),
            ("RECORDER", self.file("recorder.js")?.as_bytes().to_vec()),
            ("LIBRARY", self.wasm.clone()),
        ] {
            writeln!(script, "globalThis.{name} = \"{}\";", gzipped(&text)?)?;
        }
        script.push_str(self.file("app.js")?);
        let policy = format!(
            "default-src 'none'; script-src '{}' 'wasm-unsafe-eval' blob: data:; style-src '{}'; img-src blob: data:; \
             worker-src blob:; connect-src data:; base-uri 'none'; form-action 'none'",
            hash(&script),
            hash(style)
        );
        let mut page = with_policy(self.file("index.html")?, &policy)?;
        for link in LINKS {
            page = replaced(&page, link, "")?;
        }
        page = replaced(&page, STYLE, &format!("<style>{style}</style>"))?;
        page = replaced(&page, SCRIPT, "")?;
        let last = format!("<script>{script}</script>\n</body>");
        fs::write(path, replaced(&page, "</body>", &last)?)?;
        Ok(())
    }
}

fn with_policy(page: &str, policy: &str) -> Result<String, String> {
    let head = "<meta charset=\"utf-8\">";
    let meta =
        format!("{head}\n<meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">");
    replaced(page, head, &meta)
}

/// The text with one part replaced, which has to be there once.
fn replaced(text: &str, part: &str, by: &str) -> Result<String, String> {
    match text.matches(part).count() {
        1 => Ok(text.replacen(part, by, 1)),
        count => Err(format!("{count} times in the page: {part}")),
    }
}

fn gzipped(bytes: &[u8]) -> Result<String, Box<dyn Error>> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes)?;
    Ok(STANDARD.encode(encoder.finish()?))
}

/// A script or style as the policy names it.
fn hash(text: &str) -> String {
    format!("sha256-{}", STANDARD.encode(Sha256::digest(text)))
}

/// A script without the lines that are comments alone, and without those that describe the library's functions: who reads the
/// page's code reads it in `page/`.
fn without_comments(script: &str) -> String {
    let mut described = false;
    let is_code = |line: &&str| {
        let line = line.trim();
        described |= line.starts_with("/**");
        let is_comment = described || line.starts_with("//");
        described &= !line.ends_with("*/");
        !is_comment
    };
    let code = script.lines().filter(is_code);
    code.flat_map(|line| [line, "\n"]).collect()
}

#[cfg(test)]
mod tests {
    use super::without_comments;

    #[test]
    fn comments_go_and_products_stay() {
        let script =
            "/**\n * Adds.\n */\nadd(a,\n  b)\n  // Twice.\n  * 2; // here\n/** One. */\nf();\n";
        assert_eq!(
            without_comments(script),
            "add(a,\n  b)\n  * 2; // here\nf();\n"
        );
    }
}
