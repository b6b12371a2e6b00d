module Tumblesight {

  @ A frame of rays x rays ranges along the rays, row by row from the top left.
  port LidarFrame(
    exposureTime_ns: I64 @< of the component's clock
    sequenceNumber: U32
    fov_urad: U32 @< full field of view of both axes
    rays: U16 @< per side, at most 128
    ref ranges: Fw.Buffer @< U16 in the processor's byte order [1/128 m]; 0: no return
  )

  @ The chaser's attitude, or rather that of its LiDAR: v_inertial = q v_lrf, in Q30.
  @ False: it is not known.
  port ChaserAttitude(
    ref time_ns: I64 @< in: for which it is wanted; out: for which it holds
    ref qw: I32
    ref qx: I32
    ref qy: I32
    ref qz: I32
  ) -> bool

  @ The attitude of a target from LiDAR frames. Queued, so that no sender waits for a step, which takes
  @ up to half a period: the rate group's thread handles everything that has arrived, then runs the step.
  queued component AttitudeInit {

    @ The cycle: a rate group of 2.7 s
    sync input port schedIn: Svc.Sched

    @ Frames. The buffer is returned after the step
    async input port frameIn: LidarFrame hook
    output port frameReturnOut: Fw.BufferSend

    @ Telecommand packets of docs/icd.md. The cycle copies them and returns their buffers
    async input port commandIn: Fw.BufferSend hook
    output port commandReturnOut: Fw.BufferSend

    @ Telemetry packets of docs/icd.md, in buffers from a buffer manager. The receiver returns them to it
    output port packetAllocate: Fw.BufferGet
    output port packetOut: Fw.BufferSend

    @ Optional
    output port chaserGet: ChaserAttitude

    @ Optional: once per cycle in which every duty was done
    output port watchdogOut: Svc.WatchDog

    time get port timeCaller
    event port logOut
    text event port logTextOut
    telemetry port tlmOut

    @ No bank holds a usable model, or the settings are wrong
    event BootFailed(reason: string size 80) severity warning high \
      format "{}"

    @ Events of the application: number and arguments as in docs/icd.md
    event Information(number: U16, argument1: I32, argument2: I32, argument3: I32) severity activity high \
      format "Event {}: {}, {}, {}"
    event Warning(number: U16, argument1: I32, argument2: I32, argument3: I32) severity warning low \
      format "Event {}: {}, {}, {}"
    event Error(number: U16, argument1: I32, argument2: I32, argument3: I32) severity warning high \
      format "Event {}: {}, {}, {}"

    @ The values of docs/icd.md. The packets hold all of them
    telemetry Mode: U8
    telemetry Validity: U8
    telemetry FramesUsed: U32
    telemetry PosesVerified: U32
    telemetry StepTime_us: U32

    @ For lack of a buffer
    telemetry PacketsLost: U32

  }

}
