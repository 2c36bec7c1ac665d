//! The paper's numbers on the shipped compounds.

use tread_block::block::Reductions;
use tread_block::params::load;
use tread_block::study::identify::objective::{compare, Fineness};
use tread_block::study::margin;
use tread_block::study::measured::Measurements;
use tread_block::study::paper::{Cell, Column, TABLE_1};
use tread_block::study::start::Start;
use tread_block::study::table_one::TableOne;
use tread_block::{study, Params};

fn compound(name: &str) -> Params {
    let path = format!("{}/compounds/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    load::from_toml(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn table(name: &str, columns: &[Column]) -> TableOne {
    let reductions = Reductions::default();
    TableOne::simulate(&compound(name), columns, &Fineness::FINE, Start::Braking, &reductions)
}

#[test]
fn the_short_blocks_have_the_papers_frequencies() {
    // Table 1 of the paper; 10 % is what the issue allows any cell.
    let columns = [TABLE_1[0], TABLE_1[1]];
    let cells = compare(
        &compound("paper"),
        &columns,
        &Fineness::COARSE,
        Start::Braking,
        &Reductions::default(),
    );
    for cell in &cells {
        let name = format!("{} row {}: {:.0} Hz", cell.column.name, cell.row, cell.hz());
        assert!(cell.agrees(), "{name}: silent or loud against the paper");
        if let Some(error) = cell.error() {
            assert!(error.abs() <= 0.10, "{name}: {:+.1} %", 100.0 * error);
        }
    }
}

#[test]
fn table_1_is_reproduced() {
    // The hard numbers of the project: median 4 %, largest 10 %, the right cells silent.
    let table = table("paper", &TABLE_1);
    println!("{}", table.text());
    assert!(table.median_error() <= 0.04, "median {}", table.median_error());
    assert!(table.max_error() <= 0.10, "largest {}", table.max_error());
    assert!(table.disagreements().is_empty());
}

#[test]
fn silence_stands_one_per_cent_more_or_less_of_friction_and_damping() {
    // Parameters that are right at one point only are right by luck: no block that is silent in the paper vibrates
    // beside it either, and the median stays within the 4 % of the table itself.
    let reductions = Reductions::default();
    let tables = margin::tables(&compound("paper"), &TABLE_1, &Fineness::FINE, &reductions);
    println!("{}", margin::text(&tables));
    for (change, table) in &tables {
        assert!(table.median_error() <= 0.04, "{change:?}: median {}", table.median_error());
        for cell in table.disagreements() {
            assert!(cell.cell() != Cell::Silent, "{change:?}: {} vibrates", cell.place());
        }
    }
}

#[test]
fn two_columns_predict_the_other_two() {
    // The project's own bound: the compound of h10l15 and h6l45 alone gives the others within a median of 8 %.
    let table = table("two-columns", &[TABLE_1[1], TABLE_1[2]]);
    println!("{}", table.text());
    assert!(table.median_error() <= 0.08, "median {}", table.median_error());
}

/// Statements of the paper about a figure that do not hold on the paper's compound.
fn refuted(figure: &str) -> Vec<String> {
    let measured = Measurements::new(None, None, None).unwrap();
    let studies =
        study::run(figure, &compound("paper"), &Fineness::FINE, &measured, |_, _, _| {}).unwrap();
    let verdicts = studies.iter().flat_map(|s| &s.verdicts);
    let (holds, fails): (Vec<_>, Vec<_>) = verdicts.partition(|v| v.holds);
    assert!(!holds.is_empty());
    fails.iter().map(|v| v.line()).collect()
}

#[test]
fn friction_falls_with_speed_and_the_contact_stiffens() {
    assert_eq!(refuted("fig-2"), Vec::<String>::new());
}

#[test]
fn the_base_case_vibrates_near_2550_hz_and_most_at_the_road() {
    assert_eq!(refuted("fig-4"), Vec::<String>::new());
}

#[test]
fn the_amplitude_falls_and_the_frequency_rises_with_modulus_and_damping() {
    assert_eq!(refuted("fig-5"), Vec::<String>::new());
}

#[test]
fn a_block_vibrates_from_100_to_400_mm_per_s_only() {
    // The one statement that does not hold: the sticking phase at 400 mm/s is prominent (ADR 0001).
    let refuted = refuted("fig-6");
    assert!(refuted.iter().all(|line| line.contains("at 400 mm/s")), "{refuted:?}");
}

#[test]
fn the_amplitude_rises_with_pressure_and_height_and_falls_with_length() {
    assert_eq!(refuted("fig-7"), Vec::<String>::new());
}

#[test]
fn a_rolling_block_runs_in_sticks_slides_with_stick_slip_and_snaps_out() {
    assert_eq!(refuted("fig-8"), Vec::<String>::new());
    assert_eq!(refuted("fig-9"), Vec::<String>::new());
}

#[test]
fn the_csv_leaves_the_lost_cell_empty_and_writes_silence_as_zero() {
    // Columns and conventions are the issue's.
    let table = TableOne { cells: Vec::new() };
    assert_eq!(table.csv(), "height_m,length_m,speed_m_s,paper_hz,model_hz\n");
    assert_eq!(TABLE_1[2].cells[4].hz(), None);
    assert_eq!(Cell::Silent.hz(), Some(0.0));
}
