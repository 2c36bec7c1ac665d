//! `modelDescription.xml`, written from the table.

use crate::stage::{Role, Stage, Variable};
use std::collections::BTreeSet;
use std::fmt::Write;

/// Base units of SI with their exponents, as `UnitDefinitions` wants them.
const UNITS: &[(&str, &str)] = &[
    ("1", ""),
    ("m", "m=\"1\""),
    ("m2", "m=\"2\""),
    ("m/s", "m=\"1\" s=\"-1\""),
    ("s", "s=\"1\""),
    ("Hz", "s=\"-1\""),
    ("N", "kg=\"1\" m=\"1\" s=\"-2\""),
    ("Pa.s", "kg=\"1\" m=\"-1\" s=\"-1\""),
    ("Pa", "kg=\"1\" m=\"-1\" s=\"-2\""),
    ("kg/m2", "kg=\"1\" m=\"-2\""),
    ("kg/m3", "kg=\"1\" m=\"-3\""),
    ("rad", "rad=\"1\""),
    ("dB", ""),
];

/// GUID of a stage: FNV-1a of the description without it, so that both always fit.
pub fn guid<S: Stage>() -> String {
    let hash = body::<S>().bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    format!("{}-{hash:016x}", S::IDENTIFIER)
}

/// The whole description.
pub fn xml<S: Stage>() -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription fmiVersion=\"2.0\" \
         modelName=\"{}\" guid=\"{}\" description=\"{}\" version=\"{}\" \
         variableNamingConvention=\"structured\">\n{}</fmiModelDescription>\n",
        S::IDENTIFIER,
        guid::<S>(),
        S::DESCRIPTION,
        env!("CARGO_PKG_VERSION"),
        body::<S>()
    )
}

fn body<S: Stage>() -> String {
    let table = S::table();
    let mut out = String::new();
    // Writing to a String cannot fail.
    let _ = write!(
        out,
        "  <CoSimulation modelIdentifier=\"{}\" canHandleVariableCommunicationStepSize=\"true\" \
         canInterpolateInputs=\"{}\" maxOutputDerivativeOrder=\"{}\" canGetAndSetFMUstate=\"true\"/>\n\
         {}  <LogCategories>\n    <Category name=\"logStatusError\"/>\n  </LogCategories>\n  \
         <DefaultExperiment startTime=\"0\" stopTime=\"0.022\" stepSize=\"{:e}\"/>\n  \
         <ModelVariables>\n",
        S::IDENTIFIER,
        S::TAKES_DERIVATIVES,
        S::DERIVATIVES,
        units(&table),
        S::STEP
    );
    for (reference, variable) in table.iter().enumerate() {
        out.push_str(&scalar(reference, variable));
    }
    out.push_str("  </ModelVariables>\n  <ModelStructure>\n");
    for list in ["Outputs", "InitialUnknowns"] {
        let _ = writeln!(out, "    <{list}>");
        for (place, _) in table.iter().enumerate().filter(|(_, v)| v.role == Role::Output) {
            let _ = writeln!(out, "      <Unknown index=\"{}\"/>", place + 1);
        }
        let _ = writeln!(out, "    </{list}>");
    }
    out.push_str("  </ModelStructure>\n");
    out
}

fn units(table: &[Variable]) -> String {
    let used: BTreeSet<_> = table.iter().map(|variable| variable.unit).collect();
    let line = |unit: &str| {
        let base = UNITS.iter().find(|(name, _)| *name == unit).map_or("", |(_, base)| base);
        format!("    <Unit name=\"{unit}\">\n      <BaseUnit {base}/>\n    </Unit>\n")
    };
    let lines: String = used.into_iter().map(line).collect();
    format!("  <UnitDefinitions>\n{lines}  </UnitDefinitions>\n")
}

fn scalar(reference: usize, variable: &Variable) -> String {
    let (kind, initial) = match variable.role {
        Role::Parameter => ("causality=\"parameter\" variability=\"fixed\"", " initial=\"exact\""),
        Role::Input => ("causality=\"input\" variability=\"continuous\"", ""),
        Role::Output => {
            ("causality=\"output\" variability=\"continuous\"", " initial=\"calculated\"")
        }
    };
    let mut real = format!("<Real unit=\"{}\"", variable.unit);
    if variable.role != Role::Output {
        let _ = write!(real, " start=\"{}\"", variable.start);
    }
    if variable.role == Role::Parameter {
        let (low, high) = variable.range;
        let _ = write!(real, " min=\"{low}\" max=\"{high}\"");
    }
    format!(
        "    <ScalarVariable name=\"{}\" valueReference=\"{reference}\" {kind}{initial} \
         description=\"{}\">\n      {real}/>\n    </ScalarVariable>\n",
        variable.name, variable.doc
    )
}
