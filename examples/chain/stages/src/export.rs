//! The C functions of one stage's shared library.

/// Writes all functions of FMI 2.0 co-simulation for the stage `$stage`.
#[macro_export]
macro_rules! export {
    ($stage:ty) => {
        #[allow(non_snake_case, clippy::missing_safety_doc)]
        mod exported {
            use super::*;
            use $crate::c_interface::{self, each, with};
            use $crate::fmi::*;

            type Refs = *const fmi2ValueReference;

            #[no_mangle]
            pub extern "C" fn fmi2GetTypesPlatform() -> fmi2String {
                fmi2TypesPlatform.as_ptr().cast()
            }
            #[no_mangle]
            pub extern "C" fn fmi2GetVersion() -> fmi2String {
                fmi2Version.as_ptr().cast()
            }
            #[no_mangle]
            pub unsafe extern "C" fn fmi2Instantiate(
                name: fmi2String,
                kind: fmi2Type,
                guid: fmi2String,
                _resources: fmi2String,
                functions: *const fmi2CallbackFunctions,
                _visible: fmi2Boolean,
                _logging: fmi2Boolean,
            ) -> fmi2Component {
                c_interface::instantiate::<$stage>(name, kind, guid, functions)
            }
            #[no_mangle]
            pub unsafe extern "C" fn fmi2FreeInstance(c: fmi2Component) {
                c_interface::free::<$stage>(c)
            }
            #[no_mangle]
            pub unsafe extern "C" fn fmi2SetDebugLogging(
                c: fmi2Component,
                _on: fmi2Boolean,
                _n: usize,
                _categories: *const fmi2String,
            ) -> fmi2Status {
                with::<$stage>(c, |_| Ok(()))
            }
            #[no_mangle]
            pub unsafe extern "C" fn fmi2SetupExperiment(
                c: fmi2Component,
                _tolerance_defined: fmi2Boolean,
                _tolerance: fmi2Real,
                start: fmi2Real,
                _stop_defined: fmi2Boolean,
                _stop: fmi2Real,
            ) -> fmi2Status {
                with::<$stage>(c, |i| i.set_up(start))
            }
            #[no_mangle]
            pub unsafe extern "C" fn fmi2EnterInitializationMode(c: fmi2Component) -> fmi2Status {
                with::<$stage>(c, |i| i.enter())
            }
            #[no_mangle]
            pub unsafe extern "C" fn fmi2ExitInitializationMode(c: fmi2Component) -> fmi2Status {
                with::<$stage>(c, |i| i.exit())
            }
            #[no_mangle]
            pub unsafe extern "C" fn fmi2Terminate(c: fmi2Component) -> fmi2Status {
                with::<$stage>(c, |i| i.terminate())
            }
            #[no_mangle]
            pub unsafe extern "C" fn fmi2Reset(c: fmi2Component) -> fmi2Status {
                with::<$stage>(c, |i| i.reset())
            }
            #[no_mangle]
            pub unsafe extern "C" fn fmi2DoStep(
                c: fmi2Component,
                time: fmi2Real,
                h: fmi2Real,
                _keep: fmi2Boolean,
            ) -> fmi2Status {
                with::<$stage>(c, |i| i.step(time, h))
            }
            #[no_mangle]
            pub unsafe extern "C" fn fmi2SetReal(
                c: fmi2Component,
                vr: Refs,
                n: usize,
                x: *const fmi2Real,
            ) -> fmi2Status {
                let null = vr.is_null() || x.is_null();
                with::<$stage>(c, |i| each(n, null, |k| i.set(*vr.add(k), *x.add(k))))
            }
            #[no_mangle]
            pub unsafe extern "C" fn fmi2GetReal(
                c: fmi2Component,
                vr: Refs,
                n: usize,
                x: *mut fmi2Real,
            ) -> fmi2Status {
                let null = vr.is_null() || x.is_null();
                with::<$stage>(c, |i| each(n, null, |k| Ok(*x.add(k) = i.get(*vr.add(k))?)))
            }
            #[no_mangle]
            pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
                c: fmi2Component,
                vr: Refs,
                n: usize,
                order: *const fmi2Integer,
                x: *const fmi2Real,
            ) -> fmi2Status {
                let null = vr.is_null() || order.is_null() || x.is_null();
                with::<$stage>(c, |i| {
                    each(n, null, |k| i.set_rate(*vr.add(k), *order.add(k), *x.add(k)))
                })
            }
            #[no_mangle]
            pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
                c: fmi2Component,
                vr: Refs,
                n: usize,
                order: *const fmi2Integer,
                x: *mut fmi2Real,
            ) -> fmi2Status {
                let null = vr.is_null() || order.is_null() || x.is_null();
                with::<$stage>(c, |i| {
                    each(n, null, |k| Ok(*x.add(k) = i.rate(*vr.add(k), *order.add(k))?))
                })
            }
            #[no_mangle]
            pub unsafe extern "C" fn fmi2GetFMUstate(
                c: fmi2Component,
                state: *mut fmi2FMUstate,
            ) -> fmi2Status {
                c_interface::get_state::<$stage>(c, state)
            }
            #[no_mangle]
            pub unsafe extern "C" fn fmi2SetFMUstate(
                c: fmi2Component,
                state: fmi2FMUstate,
            ) -> fmi2Status {
                c_interface::set_state::<$stage>(c, state)
            }
            #[no_mangle]
            pub unsafe extern "C" fn fmi2FreeFMUstate(
                c: fmi2Component,
                state: *mut fmi2FMUstate,
            ) -> fmi2Status {
                c_interface::free_state::<$stage>(c, state)
            }

            // Stages have real variables only; importers look these up all the same.
            $crate::not_offered! { $stage:
                fmi2GetInteger, fmi2GetBoolean, fmi2GetString, fmi2SetInteger, fmi2SetBoolean,
                fmi2SetString, fmi2SerializedFMUstateSize, fmi2SerializeFMUstate,
                fmi2DeSerializeFMUstate, fmi2GetDirectionalDerivative, fmi2CancelStep,
                fmi2GetStatus, fmi2GetRealStatus, fmi2GetIntegerStatus, fmi2GetBooleanStatus,
                fmi2GetStringStatus,
            }
        }
    };
}

/// Functions that refuse whatever they are asked; all begin with the component, and C lets a callee
/// leave its other arguments unread.
#[macro_export]
macro_rules! not_offered {
    ($stage:ty: $($name:ident),* $(,)?) => {$(
        #[no_mangle]
        pub unsafe extern "C" fn $name(c: fmi2Component) -> fmi2Status {
            with::<$stage>(c, |_| Err(concat!(stringify!($name), " is not offered").into()))
        }
    )*};
}
