//! The state machine of FMI 2.0 co-simulation as data: which function may be called when.
//!
//! Source: FMI for Model Exchange and Co-Simulation 2.0.x, section 4.2.4, table of allowed calls.

/// Where an instance stands, in the order of the columns of the standard's table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// After `fmi2Instantiate` or `fmi2Reset`.
    Instantiated,
    /// Between `fmi2EnterInitializationMode` and `fmi2ExitInitializationMode`.
    Initialization,
    /// Ready for the next step.
    StepComplete,
    /// A step runs in the background; never, this FMU is not asynchronous.
    StepInProgress,
    /// `fmi2DoStep` answered fmi2Discard.
    StepFailed,
    /// A background step was cancelled; never.
    StepCanceled,
    /// After `fmi2Terminate`.
    Terminated,
    /// A function answered fmi2Error.
    Error,
    /// A function answered fmi2Fatal.
    Fatal,
}

impl Phase {
    /// All phases, in the order of the table.
    pub const ALL: [Self; 9] = [
        Self::Instantiated,
        Self::Initialization,
        Self::StepComplete,
        Self::StepInProgress,
        Self::StepFailed,
        Self::StepCanceled,
        Self::Terminated,
        Self::Error,
        Self::Fatal,
    ];

    /// The phase of this number, as stored in a state.
    pub fn from_number(number: u8) -> Option<Self> {
        Self::ALL.get(usize::from(number)).copied()
    }

    /// Its name in the standard's figure.
    pub fn name(self) -> &'static str {
        match self {
            Self::Instantiated => "instantiated",
            Self::Initialization => "initialization mode",
            Self::StepComplete => "step complete",
            Self::StepInProgress => "step in progress",
            Self::StepFailed => "step failed",
            Self::StepCanceled => "step canceled",
            Self::Terminated => "terminated",
            Self::Error => "error",
            Self::Fatal => "fatal",
        }
    }
}

/// Functions of the interface that need an instance; functions in one row share a line of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Call {
    /// `fmi2SetDebugLogging`
    SetDebugLogging,
    /// `fmi2FreeInstance`
    FreeInstance,
    /// `fmi2SetupExperiment`
    SetupExperiment,
    /// `fmi2EnterInitializationMode`
    EnterInitializationMode,
    /// `fmi2ExitInitializationMode`
    ExitInitializationMode,
    /// `fmi2Terminate`
    Terminate,
    /// `fmi2Reset`
    Reset,
    /// `fmi2GetReal`, `fmi2GetInteger`, `fmi2GetBoolean`, `fmi2GetString`
    Get,
    /// `fmi2SetReal`, `fmi2SetInteger`, `fmi2SetBoolean`, `fmi2SetString`
    Set,
    /// `fmi2GetFMUstate`
    GetState,
    /// `fmi2SetFMUstate`
    SetState,
    /// `fmi2FreeFMUstate`
    FreeState,
    /// `fmi2SerializedFMUstateSize`, `fmi2SerializeFMUstate`, `fmi2DeSerializeFMUstate`
    SerializeState,
    /// `fmi2GetDirectionalDerivative`
    GetDirectionalDerivative,
    /// `fmi2SetRealInputDerivatives`
    SetInputDerivatives,
    /// `fmi2GetRealOutputDerivatives`
    GetOutputDerivatives,
    /// `fmi2DoStep`
    DoStep,
    /// `fmi2CancelStep`
    CancelStep,
    /// `fmi2GetStatus` and its kin
    GetStatus,
    /// The functions of model exchange, which this FMU does not offer
    ModelExchange,
}

const X: bool = true;
const O: bool = false;

/// Allowed calls: a row per function, a column per phase in the order of [`Phase::ALL`].
#[rustfmt::skip]
pub const ALLOWED: &[(Call, [bool; 9])] = &[
    //                                 instantiated
    //                                 |  initialization
    //                                 |  |  step complete
    //                                 |  |  |  in progress
    //                                 |  |  |  |  failed
    //                                 |  |  |  |  |  canceled
    //                                 |  |  |  |  |  |  terminated
    //                                 |  |  |  |  |  |  |  error
    //                                 |  |  |  |  |  |  |  |  fatal
    (Call::SetDebugLogging,           [X, X, X, X, X, X, X, X, O]),
    // The standard forbids the call in `fatal`; an importer that must clean up may still do it.
    (Call::FreeInstance,              [X, X, X, O, X, X, X, X, X]),
    (Call::SetupExperiment,           [X, O, O, O, O, O, O, O, O]),
    (Call::EnterInitializationMode,   [X, O, O, O, O, O, O, O, O]),
    (Call::ExitInitializationMode,    [O, X, O, O, O, O, O, O, O]),
    (Call::Terminate,                 [O, O, X, O, X, O, O, O, O]),
    (Call::Reset,                     [X, X, X, O, X, X, X, X, O]),
    (Call::Get,                       [O, X, X, O, X, X, X, X, O]),
    (Call::Set,                       [X, X, X, O, O, O, O, O, O]),
    (Call::GetState,                  [X, X, X, O, X, X, X, X, O]),
    (Call::SetState,                  [X, X, X, O, X, X, X, X, O]),
    (Call::FreeState,                 [X, X, X, O, X, X, X, X, O]),
    (Call::SerializeState,            [X, X, X, O, X, X, X, X, O]),
    (Call::GetDirectionalDerivative,  [O, X, X, O, X, X, X, X, O]),
    (Call::SetInputDerivatives,       [X, X, X, O, O, O, O, O, O]),
    (Call::GetOutputDerivatives,      [O, O, X, O, X, X, X, X, O]),
    (Call::DoStep,                    [O, O, X, O, O, O, O, O, O]),
    (Call::CancelStep,                [O, O, O, X, O, O, O, O, O]),
    (Call::GetStatus,                 [O, O, X, X, X, O, X, O, O]),
    (Call::ModelExchange,             [O, O, O, O, O, O, O, O, O]),
];

/// May `call` be made in `phase`?
pub fn allows(phase: Phase, call: Call) -> bool {
    ALLOWED.iter().any(|(c, row)| *c == call && row[phase as usize])
}

/// Names of the phases in which `call` may be made.
pub fn where_allowed(call: Call) -> String {
    let names: Vec<_> =
        Phase::ALL.into_iter().filter(|p| allows(*p, call)).map(Phase::name).collect();
    if names.is_empty() {
        "no state, this FMU offers co-simulation only".into()
    } else {
        names.join(", ")
    }
}
