use super::*;

/// Rows of files whose names hold what CSV and JSON must quote, in the form that `rows` and `failure` give them.
const NAMES: [&str; 5] = ["a.wav", "b, c\n.wav", "\"d\".wav", "é\r\n.wav", "\n"];

/// A table with two drops in its second file.
fn csv_text() -> (String, Vec<usize>) {
    let (mut text, mut ends) = (drops::header(), Vec::new());
    for (i, name) in NAMES.iter().enumerate() {
        let failure = drops::failure(name, "it is empty");
        if i == 1 {
            let drop = failure.replacen(",0,error,it is empty,,", ",2,drop,,0.9,", 1);
            for number in ["1", "2"] {
                let at = drop.find(",,2,drop").unwrap() + 1;
                let mut row = drop.clone();
                row.insert_str(at, number);
                // The column of bounces.
                text += &row.replacen(",0.9,,,,,,", ",0.9,,,,,,7", 1);
            }
        } else {
            text += &failure;
        }
        ends.push(text.len());
    }
    (text, ends)
}

fn lines_text() -> (String, Vec<usize>) {
    let (mut text, mut ends) = (String::new(), Vec::new());
    for name in NAMES {
        text += &Format::Ndjson.failure(name, "it is empty");
        ends.push(text.len());
    }
    (text, ends)
}

#[test]
fn wherever_it_was_cut_off_whole_files_are_read_back_and_no_more() {
    for (format, (text, ends)) in [(Format::Csv, csv_text()), (Format::Ndjson, lines_text())] {
        for cut in 0..=text.len() {
            let back = format.read_back(&text.as_bytes()[..cut]).unwrap();
            let back = back.unwrap_or_else(|| panic!("{format:?} cut at {cut}"));
            let whole = ends.iter().filter(|&&end| end <= cut).count();
            let files: Vec<&str> = back.digests.iter().map(|d| d.file.as_str()).collect();
            assert_eq!(files, NAMES[..whole], "{format:?} cut at {cut}");
            let head = format.header().len();
            let start = if cut >= head { head } else { 0 };
            let end = whole.checked_sub(1).map_or(start, |last| ends[last]);
            assert_eq!(back.end, end as u64, "{format:?} cut at {cut}");
        }
    }
}

#[test]
fn the_drops_of_a_file_are_read_back_with_their_place() {
    let (text, ends) = csv_text();
    let back = Format::Csv.read_back(text.as_bytes()).unwrap().unwrap();
    let drop = DropDigest {
        bounces: 7,
        restitution: Some(Estimate::bare(0.9)),
        ..DropDigest::default()
    };
    assert_eq!(back.digests[1].found, Found::Drops(vec![drop, drop]));
    assert_eq!(
        back.digests[0].found,
        Found::Failed("it is empty".to_owned())
    );
    assert_eq!(back.sample, Some((1, ends[0] as u64..ends[1] as u64)));
}

#[test]
fn what_this_program_did_not_write_is_no_beginning() {
    let (table, _) = csv_text();
    let swapped = table.replacen(",2,2,drop", ",3,3,drop", 1);
    for other in [
        "a;b\n1;2\n",
        "hello",
        "file,drop\n",
        "{\"file\":1}\n",
        &swapped,
    ] {
        assert!(
            Format::Csv.read_back(other.as_bytes()).unwrap().is_none(),
            "{other}"
        );
        assert!(
            Format::Ndjson
                .read_back(other.as_bytes())
                .unwrap()
                .is_none(),
            "{other}"
        );
    }
}
