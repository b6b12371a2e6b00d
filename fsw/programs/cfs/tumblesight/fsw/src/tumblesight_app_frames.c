#include "tumblesight_app_frames.h"

#include <string.h>

#include "tumblesight_app.h"
#include "tumblesight_app_eventids.h"
#include "tumblesight_app_platform.h"

/* A frame that has not arrived whole by then is dropped. */
#define TUMBLESIGHT_APP_FRAME_CYCLES 2

static uint32 RaysOf(const TUMBLESIGHT_APP_FrameSegment_Payload_t* Segment) {
  return (uint32)Segment->Rays * Segment->Rays;
}

/* Ranges of the segment that begins at the offset. */
static uint32 CountAt(uint32 Offset, uint32 Rays) {
  const uint32 Left = Rays - Offset;
  return Left < TUMBLESIGHT_APP_SEGMENT_RAYS ? Left : TUMBLESIGHT_APP_SEGMENT_RAYS;
}

static bool IsPossible(const TUMBLESIGHT_APP_FrameSegment_Payload_t* Segment) {
  if (Segment->Rays < 1 || Segment->Rays > TUMBLESIGHT_MAX_RAYS) return false;
  if (Segment->Offset % TUMBLESIGHT_APP_SEGMENT_RAYS != 0 || Segment->Offset >= RaysOf(Segment)) return false;
  return Segment->Count == CountAt(Segment->Offset, RaysOf(Segment));
}

static bool IsSameTime(CFE_TIME_SysTime_t A, CFE_TIME_SysTime_t B) {
  return A.Seconds == B.Seconds && A.Subseconds == B.Subseconds;
}

static bool IsSameAttitude(const TUMBLESIGHT_APP_Attitude_t* A, const TUMBLESIGHT_APP_Attitude_t* B) {
  return IsSameTime(A->Time, B->Time) && A->IsKnown == B->IsKnown &&
         memcmp(A->Q_Inertial_Lrf, B->Q_Inertial_Lrf, sizeof A->Q_Inertial_Lrf) == 0;
}

static bool IsSameFrame(const TUMBLESIGHT_APP_FrameSegment_Payload_t* A,
                        const TUMBLESIGHT_APP_FrameSegment_Payload_t* B) {
  return A->SequenceNumber == B->SequenceNumber && IsSameTime(A->Exposure, B->Exposure);
}

static bool AreAlike(const TUMBLESIGHT_APP_FrameSegment_Payload_t* A,
                     const TUMBLESIGHT_APP_FrameSegment_Payload_t* B) {
  return A->Fov_urad == B->Fov_urad && A->Rays == B->Rays && IsSameAttitude(&A->Chaser, &B->Chaser);
}

static void Free(TUMBLESIGHT_APP_FrameBuffer_t* Buffer) {
  Buffer->Age = 0;
  Buffer->Missing = 0;
}

/* The buffer of a frame that is not yet complete; NULL: this is its first segment. A frame that the sensor
 * sends twice is assembled twice: the flight application counts it as a duplicate. */
static TUMBLESIGHT_APP_FrameBuffer_t* FindBuffer(const TUMBLESIGHT_APP_FrameSegment_Payload_t* Segment) {
  TUMBLESIGHT_APP_FrameBuffer_t* Buffers = TUMBLESIGHT_APP_Data.Frames.Buffers;
  uint32 i;
  for (i = 0; i < TUMBLESIGHT_APP_FRAME_BUFFERS; ++i)
    if (Buffers[i].Missing != 0 && IsSameFrame(&Buffers[i].First, Segment)) return &Buffers[i];
  return NULL;
}

/* A free buffer, or else the one of the frame that came first: newer frames are worth more. */
static TUMBLESIGHT_APP_FrameBuffer_t* TakeBuffer(void) {
  TUMBLESIGHT_APP_Frames_t* Frames = &TUMBLESIGHT_APP_Data.Frames;
  TUMBLESIGHT_APP_FrameBuffer_t* Oldest = &Frames->Buffers[0];
  uint32 i;
  for (i = 1; i < TUMBLESIGHT_APP_FRAME_BUFFERS; ++i)
    if (Frames->Buffers[i].Age < Oldest->Age) Oldest = &Frames->Buffers[i];
  if (Oldest->Age != 0) {
    ++Frames->Dropped;
    if (Oldest->Missing == 0)
      ++TUMBLESIGHT_APP_COUNTERS.FramesSuperseded;
    else
      ++TUMBLESIGHT_APP_COUNTERS.FramesIncomplete;
  }
  return Oldest;
}

static TUMBLESIGHT_APP_FrameBuffer_t* BeginFrame(const TUMBLESIGHT_APP_FrameSegment_Payload_t* Segment) {
  TUMBLESIGHT_APP_FrameBuffer_t* Buffer = TakeBuffer();
  const uint32 Segments = (RaysOf(Segment) + TUMBLESIGHT_APP_SEGMENT_RAYS - 1) / TUMBLESIGHT_APP_SEGMENT_RAYS;
  memcpy(&Buffer->First, Segment, offsetof(TUMBLESIGHT_APP_FrameSegment_Payload_t, Ranges));
  Buffer->Missing = (1U << Segments) - 1;
  Buffer->Cycles = 0;
  Buffer->Age = ++TUMBLESIGHT_APP_Data.Frames.Arrivals;
  return Buffer;
}

static void Refuse(const TUMBLESIGHT_APP_FrameSegment_Payload_t* Segment) {
  ++TUMBLESIGHT_APP_COUNTERS.SegmentsRefused;
  CFE_EVS_SendEvent(TUMBLESIGHT_APP_SEGMENT_ERR_EID, CFE_EVS_EventType_ERROR,
                    "TUMBLESIGHT: frame segment refused: frame %lu, %u rays per side, %u ranges from %u",
                    (unsigned long)Segment->SequenceNumber, Segment->Rays, Segment->Count, Segment->Offset);
}

void TUMBLESIGHT_APP_TakeSegment(const TUMBLESIGHT_APP_FrameSegment_Payload_t* Segment) {
  TUMBLESIGHT_APP_FrameBuffer_t* Buffer;
  const uint32 Bit = 1U << (Segment->Offset / TUMBLESIGHT_APP_SEGMENT_RAYS);
  if (!IsPossible(Segment)) {
    Refuse(Segment);
    return;
  }
  Buffer = FindBuffer(Segment);
  if (Buffer == NULL) Buffer = BeginFrame(Segment);
  if (!AreAlike(&Buffer->First, Segment)) {
    Refuse(Segment);
    return;
  }
  ++TUMBLESIGHT_APP_COUNTERS.SegmentsTaken;
  if ((Buffer->Missing & Bit) == 0) {
    ++TUMBLESIGHT_APP_COUNTERS.SegmentsRepeated;
    return;
  }
  memcpy(&Buffer->Ranges[Segment->Offset], Segment->Ranges, Segment->Count * sizeof Segment->Ranges[0]);
  Buffer->Missing &= ~Bit;
  if (Buffer->Missing == 0) ++TUMBLESIGHT_APP_COUNTERS.FramesAssembled;
}

static bool IsComplete(const TUMBLESIGHT_APP_FrameBuffer_t* Buffer) {
  return Buffer->Age != 0 && Buffer->Missing == 0;
}

static struct tumblesight_frame FrameOf(const TUMBLESIGHT_APP_FrameBuffer_t* Buffer) {
  struct tumblesight_frame Frame;
  Frame.exposure_time_ns = TUMBLESIGHT_APP_ToNanoseconds(Buffer->First.Exposure);
  Frame.sequence_number = Buffer->First.SequenceNumber;
  Frame.fov_urad = Buffer->First.Fov_urad;
  Frame.rays = Buffer->First.Rays;
  Frame.ranges = Buffer->Ranges;
  Frame.chaser = TUMBLESIGHT_APP_ToChaser(&Buffer->First.Chaser);
  return Frame;
}

size_t TUMBLESIGHT_APP_ListFrames(void) {
  TUMBLESIGHT_APP_Frames_t* Frames = &TUMBLESIGHT_APP_Data.Frames;
  const TUMBLESIGHT_APP_FrameBuffer_t* Next;
  uint32 Age = 0;
  size_t Listed = 0;
  uint32 i;
  do {
    Next = NULL;
    for (i = 0; i < TUMBLESIGHT_APP_FRAME_BUFFERS; ++i)
      if (IsComplete(&Frames->Buffers[i]) && Frames->Buffers[i].Age > Age &&
          (Next == NULL || Frames->Buffers[i].Age < Next->Age))
        Next = &Frames->Buffers[i];
    if (Next != NULL) {
      Age = Next->Age;
      Frames->List[Listed++] = FrameOf(Next);
    }
  } while (Next != NULL);
  return Listed;
}

static void DropIncomplete(TUMBLESIGHT_APP_FrameBuffer_t* Buffer) {
  ++TUMBLESIGHT_APP_Data.Frames.Dropped;
  ++TUMBLESIGHT_APP_COUNTERS.FramesIncomplete;
  CFE_EVS_SendEvent(TUMBLESIGHT_APP_FRAME_ERR_EID, CFE_EVS_EventType_ERROR,
                    "TUMBLESIGHT: frame %lu dropped: segments 0x%02lx did not arrive within %d cycles",
                    (unsigned long)Buffer->First.SequenceNumber, (unsigned long)Buffer->Missing,
                    TUMBLESIGHT_APP_FRAME_CYCLES);
  Free(Buffer);
}

void TUMBLESIGHT_APP_EndFrames(void) {
  TUMBLESIGHT_APP_FrameBuffer_t* Buffers = TUMBLESIGHT_APP_Data.Frames.Buffers;
  uint32 i;
  for (i = 0; i < TUMBLESIGHT_APP_FRAME_BUFFERS; ++i) {
    if (IsComplete(&Buffers[i]))
      Free(&Buffers[i]);
    else if (Buffers[i].Age != 0 && ++Buffers[i].Cycles >= TUMBLESIGHT_APP_FRAME_CYCLES)
      DropIncomplete(&Buffers[i]);
  }
}
