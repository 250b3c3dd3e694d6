//! Every function of `physics` against 60-digit arithmetic.

#[path = "../oracle/mod.rs"]
mod oracle;

#[test]
fn every_answer_is_within_the_goal_of_the_reference() {
    let mut missed = Vec::new();
    let rows = oracle::rows();
    for row in &rows {
        let answer = oracle::answer(row.function, &row.inputs);
        let error = row.error_of(answer);
        let allowed = row.goal();
        // A NaN is a miss too.
        if error.is_nan() || error > allowed {
            let roundings = row.in_roundings(error);
            missed.push(format!(
                "{row:?}: {answer:e}, error {error:.1e} of {allowed:.1e}, {roundings:.1} times 8 roundings"
            ));
        }
    }
    assert!(rows.len() > 4600, "only {} rows", rows.len());
    assert!(
        missed.is_empty(),
        "{} missed:\n{}",
        missed.len(),
        missed.join("\n")
    );
}
