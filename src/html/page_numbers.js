// Numbers as text, and rotations.

/** Four figures, with an exponent where that is shorter. */
function figures(value, count = 4) {
  if (!isFinite(value)) return "?";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-3) return value.toExponential(count - 2).replace("e+", "e");
  return String(Number(value.toPrecision(count)));
}

/** A step of 1, 2 or 5 times a power of ten that is not less than the value. */
function roundStep(value) {
  const power = Math.pow(10, Math.floor(Math.log10(value)));
  return [1, 2, 5, 10].map((digit) => digit * power).find((step) => step >= value * (1 - 1e-9));
}

/** How many digits after the point tell times over a duration apart. */
function decimalsOf(duration) {
  return duration > 0 ? Math.min(12, Math.max(0, 4 - Math.floor(Math.log10(duration)))) : 3;
}

/** Index of the last of ascending numbers that is not greater than the value; -1 where all are. */
function lastNotAfter(numbers, value) {
  let low = 0;
  let high = numbers.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (numbers[middle] <= value) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

// Quaternions are [x, y, z, w], rotation vectors [x, y, z].

function product(a, b) {
  return [
    a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
    a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
    a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
    a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2],
  ];
}

function inverse(q) {
  return [-q[0], -q[1], -q[2], q[3]];
}

function unit(q) {
  const size = Math.hypot(q[0], q[1], q[2], q[3]);
  return size > 0 ? q.map((part) => part / size) : [0, 0, 0, 1];
}

/** The rotation by a rotation vector. */
function rotation(vector, factor = 1) {
  const angle = factor * Math.hypot(vector[0], vector[1], vector[2]);
  if (!isFinite(angle)) return [0, 0, 0, 1];
  const over = Math.abs(angle) < 1e-9 ? 0.5 * factor : (Math.sin(angle / 2) / angle) * factor;
  return [over * vector[0], over * vector[1], over * vector[2], Math.cos(angle / 2)];
}

/** The shortest rotation vector of a rotation. */
function rotationVector(q) {
  const sign = q[3] < 0 ? -1 : 1;
  const size = Math.hypot(q[0], q[1], q[2]);
  if (size < 1e-12) return [0, 0, 0];
  const over = (sign * 2 * Math.atan2(size, sign * q[3])) / size;
  return [over * q[0], over * q[1], over * q[2]];
}
