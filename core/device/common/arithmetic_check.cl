// Operations whose rounding a device must have; see arithmetic_check.h.

#if LANES > 1
typedef float16 TestedFloats;
typedef double16 TestedDoubles;
#define TESTED_FLOATS(x) convert_float16(x)
#define TESTED_DOUBLES(x) convert_double16(x)
#define LOAD_TESTED(x, i) vload16(0, (x) + (i))
#define STORE_TESTED(value, x, i) vstore16(value, 0, (x) + (i))
#else
typedef float TestedFloats;
typedef double TestedDoubles;
#define TESTED_FLOATS(x) ((float)(x))
#define TESTED_DOUBLES(x) ((double)(x))
#define LOAD_TESTED(x, i) (x)[i]
#define STORE_TESTED(value, x, i) (x)[i] = (value)
#endif

// `inputs` has three columns of `count` numbers, and `results` one column for each operation.
kernel void test_arithmetic(int count, global const double* inputs, global double* results) {
  const int i = LANES * get_global_id(0);
  if (i >= count) return;
  const TestedDoubles a = LOAD_TESTED(inputs, i);
  const TestedDoubles b = LOAD_TESTED(inputs + count, i);
  const TestedDoubles c = LOAD_TESTED(inputs + 2 * count, i);
  const TestedFloats p = TESTED_FLOATS(a);
  const TestedFloats q = TESTED_FLOATS(b);
  const TestedFloats r = TESTED_FLOATS(c);
  STORE_TESTED(TESTED_DOUBLES(p * q + r), results, i);
  STORE_TESTED(TESTED_DOUBLES(p / q), results + count, i);
  STORE_TESTED(TESTED_DOUBLES(sqrt(p)), results + 2 * count, i);
  STORE_TESTED(TESTED_DOUBLES(p * 1e-30f * 1e-12f), results + 3 * count, i);
  STORE_TESTED(a * b + c, results + 4 * count, i);
  STORE_TESTED(a / b, results + 5 * count, i);
  STORE_TESTED(sqrt(a), results + 6 * count, i);
}
