use strands::rod::Order;
use strands::statics::Settings;
use strands_cases::all;
#[test]
fn survey() {
    let names = std::env::var("CASES").unwrap_or_default();
    let tol: f64 = std::env::var("TOL").ok().and_then(|t| t.parse().ok()).unwrap_or(1e-11);
    for case in all().iter().filter(|case| names.split(',').any(|n| case.name.starts_with(n))) {
        let settings = Settings { tolerance: tol, restart_from_rest: false, ..Settings::default() };
        let n = std::env::var("N").ok().and_then(|t| t.parse().ok()).unwrap_or(case.elements);
        let t = std::time::Instant::now();
        let outs = case.solve(n, Order::Fourth, &settings);
        println!("== {} {:?}", case.name, t.elapsed());
        for (row, out) in case.rows.iter().zip(outs) {
            match out {
                Err(e) => println!("   {}: FAILED {e}", row.label),
                Ok(o) => {
                    let bad = o.comparisons.iter().map(|c| format!("{:.0e}", c.error)).collect::<Vec<_>>().join(" ");
                    println!("{} {}: worst {:.1e} answer {} idx {:?} known {:?} {:?} it {} imb {:.0e} [{bad}]", if o.worst() > case.tolerance { "!!" } else { "  " }, row.label, o.worst(), o.answer, o.solution.report.morse_index, row.answers[o.answer].index, o.solution.report.method, o.solution.report.iterations, o.solution.imbalance(&o.problem));
                }
            }
        }
    }
}
#[test]
fn critical() {
    let names = std::env::var("CRIT").unwrap_or_default();
    for case in strands_cases::all_critical().iter().filter(|case| names.split(',').any(|n| case.name.starts_with(n))) {
        let n = std::env::var("N").ok().and_then(|t| t.parse().ok()).unwrap_or(case.elements);
        for b in &case.branches {
            let t = std::time::Instant::now();
            match b.critical_loads(n, Order::Fourth) {
                Err(strands_cases::CaseError::Solve(e)) => println!("   {}: {}: FAILED {:.1e} {:?}", case.name, b.label, e.nearest.report.residual, e.nearest.report.residual_history.iter().map(|r| format!("{r:.0e}")).collect::<Vec<_>>().join(" ")),
                Err(e) => println!("   {}: {}: FAILED {e}", case.name, b.label),
                Ok(f) => {
                    let e: Vec<_> = f.iter().zip(&b.critical).map(|(f, c)| format!("{:.1e}{}", f.load / c - 1.0, if (f.load / c - 1.0).abs() > case.tolerance {"!!"} else {""})).collect();
                    println!("   {}: {}: {e:?} idx {:?} found {} of {} {:?}", case.name, b.label, f.iter().map(|f| f.index).collect::<Vec<_>>(), f.len(), b.critical.len(), t.elapsed());
                }
            }
        }
    }
}
