//! docs/report.schema.json says what the documents are: those of every kind keep to it, and what is not one does not.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use crate::common::{empty_folder, run_in, text};

fn schema() -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/report.schema.json");
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// Where a value breaks a schema, by the keywords that ours uses; an unknown one is a fault of the schema.
fn broken(root: &Value, schema: &Value, value: &Value, at: &str) -> Option<String> {
    let fault = |what: &str| Some(format!("{at}: {what}"));
    for (keyword, rule) in schema.as_object().unwrap() {
        let found = match keyword.as_str() {
            "$schema" | "title" | "$defs" | "required" | "additionalProperties" => None,
            "$ref" => broken(
                root,
                root.pointer(&rule.as_str().unwrap()[1..]).unwrap(),
                value,
                at,
            ),
            "anyOf" => {
                let choices = rule.as_array().unwrap();
                let faults: Vec<_> = choices.iter().map(|c| broken(root, c, value, at)).collect();
                let fits = faults.iter().any(Option::is_none);
                if fits {
                    None
                } else {
                    fault(&format!("{faults:?}"))
                }
            }
            "enum" if rule.as_array().unwrap().contains(value) => None,
            "enum" => fault(&format!("{value} is none of {rule}")),
            "type" if is_of(rule, value) => None,
            "type" => fault(&format!("{value} is no {rule}")),
            "items" => {
                elements(value).find_map(|(i, v)| broken(root, rule, v, &format!("{at}[{i}]")))
            }
            "minItems" if elements(value).count() as u64 >= rule.as_u64().unwrap() => None,
            "maxItems" if elements(value).count() as u64 <= rule.as_u64().unwrap() => None,
            "minItems" | "maxItems" => fault("too few or too many"),
            "properties" => fields(root, schema, value, at),
            other => panic!("{other} is not understood here"),
        };
        if found.is_some() {
            return found;
        }
    }
    None
}

fn elements(value: &Value) -> impl Iterator<Item = (usize, &Value)> {
    value.as_array().into_iter().flatten().enumerate()
}

fn is_of(rule: &Value, value: &Value) -> bool {
    let one = |name: &Value| match name.as_str().unwrap() {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_u64(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        other => panic!("{other} is no type"),
    };
    rule.as_array()
        .map_or_else(|| one(rule), |names| names.iter().any(one))
}

/// Every field is known and as it should be, and those that are required are there.
fn fields(root: &Value, schema: &Value, value: &Value, at: &str) -> Option<String> {
    let (known, there) = (
        schema["properties"].as_object().unwrap(),
        value.as_object()?,
    );
    assert_eq!(schema["additionalProperties"], false, "{at} is open");
    let required = schema["required"].as_array().unwrap();
    let missing = required
        .iter()
        .find(|name| !there.contains_key(name.as_str().unwrap()));
    if let Some(name) = missing {
        return Some(format!("{at}: {name} is missing"));
    }
    there
        .iter()
        .find_map(|(name, value)| match known.get(name) {
            None => Some(format!("{at}.{name} is not known")),
            Some(rule) => broken(root, rule, value, &format!("{at}.{name}")),
        })
}

/// Documents with and without drops, with labels, a rule, a candidate, irregular bounces, and an error.
fn documents(name: &str) -> Vec<Value> {
    let folder = empty_folder("schema", name);
    let mut documents = Vec::new();
    for (preset, options) in [
        (
            "pingpong",
            "--height 30.5cm --mass 2.7g --diameter 40mm --rule ittf-ball",
        ),
        ("three-drops", "--labels labels.txt --rule itf-tennis"),
        ("three-drops", "--impacts labels.txt"),
        ("odd-bounce", "--model constant --contact-time 0.1ms"),
        ("other-surface", ""),
        ("three-impacts", "--height 30cm"),
        ("two-impacts", ""),
        ("speech", "--start 1 --end 9"),
        ("noise", ""),
        ("silence", ""),
    ] {
        let wav = format!("{preset}.wav");
        run_in(&folder, &["synth", "--preset", preset, "-o", &wav]);
        let line = format!("analyze {wav} {options} --format json");
        let arguments: Vec<&str> = line.split_whitespace().collect();
        let output = run_in(&folder, &arguments);
        let document = serde_json::from_slice(&output.stdout);
        documents.push(document.unwrap_or_else(|e| panic!("{line}: {e} {}", text(&output.stderr))));
    }
    let output = run_in(&folder, &["analyze", "no.wav", "--format", "json"]);
    documents.push(serde_json::from_slice(&output.stdout).unwrap());
    documents
}

#[test]
fn every_document_keeps_to_the_schema() {
    let (schema, documents) = (schema(), documents("good"));
    for document in &documents {
        assert_eq!(broken(&schema, &schema, document, ""), None);
    }
    let some = |path: &str| {
        documents
            .iter()
            .any(|d| d.pointer(path).is_some_and(|v| !v.is_null()))
    };
    for path in [
        "/drops/0/ball",
        "/rule/drops/0/rebound_m",
        "/drops/0/irregular/0",
        "/error",
        "/drops/2/impacts/0",
    ] {
        assert!(some(path), "no document has {path}");
    }
}

#[test]
fn what_is_no_document_breaks_the_schema() {
    let schema = schema();
    let good = documents("bad").swap_remove(0);
    for (pointer, value) in [
        ("/drops/0/bounces", json!("67")),
        ("/drops/0/impacts/0/status", json!("seen")),
        ("/drops/0/restitution/interval95", json!([0.9])),
        ("/settings", json!({"height_m": 0.3})),
        (
            "/recording",
            json!({"sample_rate_hz": 1.0, "channels": 1, "channel": 1, "duration_s": 1.0, "encoding": "", "x": 1}),
        ),
    ] {
        let mut bad = good.clone();
        *bad.pointer_mut(pointer).unwrap() = value;
        assert!(broken(&schema, &schema, &bad, "").is_some(), "{pointer}");
    }
}
