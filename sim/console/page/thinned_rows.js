// The rows that a chart draws. A chart of a few hundred pixels cannot show ten thousand steps, so where many
// steps share a pixel they become two rows, their least and their greatest values. Nothing is lost to the eye,
// and a new step touches only the last rows.
const MOST_BUCKETS = 320;

export class ThinnedRows {
  constructor() {
    this.rows = [];
    this.clear();
  }

  clear() {
    this.rows.length = 0;
    this.bucket = 0;
    this.first = 0;
    this.next = 0;       // the step after the last row's
    this.isLastPartial = false;
  }

  /** Covers the steps from `from` to `to` - 1, of which `span` fill the chart's width. */
  cover(columns, from, to, span, isLog) {
    const bucket = bucketOf(span);
    const first = from - (from % bucket);
    if (bucket !== this.bucket || first !== this.first || to < this.next) this.begin(bucket, first);
    if (this.isLastPartial) this.dropLast();
    while (this.next < to) this.push(columns, Math.min(this.next + this.bucket, to), isLog);
    return this.rows;
  }

  begin(bucket, first) {
    this.clear();
    this.bucket = bucket;
    this.first = this.next = first;
  }

  dropLast() {
    this.rows.length -= 2;
    this.next -= this.next % this.bucket;
    this.isLastPartial = false;
  }

  push(columns, end, isLog) {
    if (this.bucket === 1) {
      this.rows.push(rowOf(columns, this.next, isLog));
    } else {
      const low = [this.next];
      const high = [this.next + this.bucket / 2];
      for (const column of columns) pushExtremes(column, this.next, end, isLog, low, high);
      this.rows.push(low, high);
      this.isLastPartial = end % this.bucket !== 0;
    }
    this.next = end;
  }
}

function bucketOf(span) {
  let bucket = 1;
  while (span > MOST_BUCKETS * bucket) bucket *= 2;
  return bucket;
}

// A logarithmic axis has no place for zero.
function isShown(value, isLog) {
  return isLog ? value > 0 : Number.isFinite(value);
}

function rowOf(columns, k, isLog) {
  const row = [k];
  for (const column of columns) row.push(isShown(column[k], isLog) ? column[k] : null);
  return row;
}

function pushExtremes(column, from, to, isLog, low, high) {
  let least = Infinity, most = -Infinity;
  for (let k = from; k < to; ++k) {
    const value = column[k];
    if (!isShown(value, isLog)) continue;
    if (value < least) least = value;
    if (value > most) most = value;
  }
  low.push(least === Infinity ? null : least);
  high.push(most === -Infinity ? null : most);
}
