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

static bool WasAssembled(const TUMBLESIGHT_APP_FrameSegment_Payload_t* Segment) {
  const TUMBLESIGHT_APP_Frames_t* Frames = &TUMBLESIGHT_APP_Data.Frames;
  for (uint32 i = 0; i < TUMBLESIGHT_APP_REMEMBERED_FRAMES && i < Frames->AssembledCount; ++i)
    if (Frames->Assembled[i].SequenceNumber == Segment->SequenceNumber &&
        IsSameTime(Frames->Assembled[i].Exposure, Segment->Exposure))
      return true;
  return false;
}

static void RememberAssembled(const TUMBLESIGHT_APP_FrameSegment_Payload_t* Segment) {
  TUMBLESIGHT_APP_Frames_t* Frames = &TUMBLESIGHT_APP_Data.Frames;
  TUMBLESIGHT_APP_FrameId_t* Id =
      &Frames->Assembled[Frames->AssembledCount++ % TUMBLESIGHT_APP_REMEMBERED_FRAMES];
  Id->SequenceNumber = Segment->SequenceNumber;
  Id->Exposure = Segment->Exposure;
}

static bool AreAlike(const TUMBLESIGHT_APP_FrameSegment_Payload_t* A,
                     const TUMBLESIGHT_APP_FrameSegment_Payload_t* B) {
  return A->Fov_urad == B->Fov_urad && A->Rays == B->Rays && IsSameAttitude(&A->Chaser, &B->Chaser);
}

static void Free(TUMBLESIGHT_APP_FrameBuffer_t* Buffer) {
  Buffer->Age = 0;
  Buffer->Missing = 0;
}

/* The buffer of a frame that is not yet complete; NULL: this is its first segment. */
static TUMBLESIGHT_APP_FrameBuffer_t* FindBuffer(const TUMBLESIGHT_APP_FrameSegment_Payload_t* Segment) {
  TUMBLESIGHT_APP_FrameBuffer_t* Buffers = TUMBLESIGHT_APP_Data.Frames.Buffers;
  for (uint32 i = 0; i < TUMBLESIGHT_APP_FRAME_BUFFERS; ++i)
    if (Buffers[i].Missing != 0 && IsSameFrame(&Buffers[i].First, Segment)) return &Buffers[i];
  return NULL;
}

/* A frame that does not reach the flight application. Repeated parts of one that did are no frame. */
static void Drop(const TUMBLESIGHT_APP_FrameBuffer_t* Buffer, const char* Why) {
  if (Buffer->IsRepeat) return;
  ++TUMBLESIGHT_APP_Data.Frames.Dropped;
  if (Buffer->Missing == 0) {
    ++TUMBLESIGHT_APP_COUNTERS.FramesSuperseded;
    return;
  }
  ++TUMBLESIGHT_APP_COUNTERS.FramesIncomplete;
  CFE_EVS_SendEvent(TUMBLESIGHT_APP_FRAME_ERR_EID, CFE_EVS_EventType_ERROR,
                    "TUMBLESIGHT: frame %lu dropped without its segments 0x%02lx: %s",
                    (unsigned long)Buffer->First.SequenceNumber, (unsigned long)Buffer->Missing, Why);
}

/* What a buffer is worth: nothing if it is free, and more if its frame is complete. */
static int RankOf(const TUMBLESIGHT_APP_FrameBuffer_t* Buffer) {
  if (Buffer->Age == 0) return 0;
  if (Buffer->IsRepeat) return 1;
  return Buffer->Missing == 0 ? 3 : 2;
}

/* The buffer that is worth least, and of several the one whose frame came first. */
static TUMBLESIGHT_APP_FrameBuffer_t* TakeBuffer(void) {
  TUMBLESIGHT_APP_FrameBuffer_t* Buffers = TUMBLESIGHT_APP_Data.Frames.Buffers;
  TUMBLESIGHT_APP_FrameBuffer_t* Least = &Buffers[0];
  for (uint32 i = 1; i < TUMBLESIGHT_APP_FRAME_BUFFERS; ++i) {
    const int Rank = RankOf(&Buffers[i]), LeastRank = RankOf(Least);
    if (Rank < LeastRank || (Rank == LeastRank && Buffers[i].Age < Least->Age)) Least = &Buffers[i];
  }
  if (Least->Age != 0) Drop(Least, "no buffer is free");
  return Least;
}

static TUMBLESIGHT_APP_FrameBuffer_t* BeginFrame(const TUMBLESIGHT_APP_FrameSegment_Payload_t* Segment) {
  TUMBLESIGHT_APP_FrameBuffer_t* Buffer = TakeBuffer();
  const uint32 Segments = (RaysOf(Segment) + TUMBLESIGHT_APP_SEGMENT_RAYS - 1) / TUMBLESIGHT_APP_SEGMENT_RAYS;
  memcpy(&Buffer->First, Segment, offsetof(TUMBLESIGHT_APP_FrameSegment_Payload_t, Ranges));
  Buffer->Missing = (1U << Segments) - 1;
  Buffer->Cycles = 0;
  Buffer->IsRepeat = WasAssembled(Segment);
  Buffer->Age = ++TUMBLESIGHT_APP_Data.Frames.Arrivals;
  return Buffer;
}

static void Refuse(const TUMBLESIGHT_APP_FrameSegment_Payload_t* Segment) {
  ++TUMBLESIGHT_APP_COUNTERS.SegmentsRefused;
  CFE_EVS_SendEvent(TUMBLESIGHT_APP_SEGMENT_ERR_EID, CFE_EVS_EventType_ERROR,
                    "TUMBLESIGHT: frame segment refused: frame %lu, %u rays per side, %u ranges from %u",
                    (unsigned long)Segment->SequenceNumber, Segment->Rays, Segment->Count, Segment->Offset);
}

/* A frame that the sensor sends twice is assembled twice: the flight application counts the second one. */
static void Complete(TUMBLESIGHT_APP_FrameBuffer_t* Buffer) {
  Buffer->IsRepeat = false;
  ++TUMBLESIGHT_APP_COUNTERS.FramesAssembled;
  RememberAssembled(&Buffer->First);
}

void TUMBLESIGHT_APP_TakeSegment(const TUMBLESIGHT_APP_FrameSegment_Payload_t* Segment) {
  const uint32 Bit = 1U << (Segment->Offset / TUMBLESIGHT_APP_SEGMENT_RAYS);
  if (!IsPossible(Segment)) {
    Refuse(Segment);
    return;
  }
  TUMBLESIGHT_APP_FrameBuffer_t* Buffer = FindBuffer(Segment);
  if (Buffer == NULL) Buffer = BeginFrame(Segment);
  if (!AreAlike(&Buffer->First, Segment)) {
    Refuse(Segment);
    return;
  }
  ++TUMBLESIGHT_APP_COUNTERS.SegmentsTaken;
  if (Buffer->IsRepeat || (Buffer->Missing & Bit) == 0) ++TUMBLESIGHT_APP_COUNTERS.SegmentsRepeated;
  if ((Buffer->Missing & Bit) == 0) return;
  memcpy(&Buffer->Ranges[Segment->Offset], Segment->Ranges, Segment->Count * sizeof Segment->Ranges[0]);
  Buffer->Missing &= ~Bit;
  if (Buffer->Missing == 0) Complete(Buffer);
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
  const TUMBLESIGHT_APP_FrameBuffer_t* Next = NULL;
  uint32 Age = 0;
  size_t Listed = 0;
  do {
    Next = NULL;
    for (uint32 i = 0; i < TUMBLESIGHT_APP_FRAME_BUFFERS; ++i)
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

void TUMBLESIGHT_APP_EndFrames(void) {
  TUMBLESIGHT_APP_FrameBuffer_t* Buffers = TUMBLESIGHT_APP_Data.Frames.Buffers;
  for (uint32 i = 0; i < TUMBLESIGHT_APP_FRAME_BUFFERS; ++i) {
    if (IsComplete(&Buffers[i])) {
      Free(&Buffers[i]);
    } else if (Buffers[i].Age != 0 && ++Buffers[i].Cycles >= TUMBLESIGHT_APP_FRAME_CYCLES) {
      Drop(&Buffers[i], "two cycles have passed");
      Free(&Buffers[i]);
    }
  }
}
