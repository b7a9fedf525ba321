// Particles with contacts, see SolidRange: parameters, steps, and cells. One work-item computes one
// particle. All numbers are in double precision. Free particles precede those of rigid bodies. The
// index of a particle does not count a liquid without contacts.

typedef struct {
  double origin[3];
  double period[3];
  double inverse_cell;
  double gravity[3];
  double field_center[3];
  double field_strength;
  double offset[3];
  double wall_low[3];
  double wall_high[3];
  double plane_low[3];
  double plane_high[3];
  double wall_velocity[3];
  double speeds_of_walls[18];
  double domain_low[3];
  double domain_high[3];
  double closing;
  double opening;
  double drift;
  double prediction;
  double prediction_of_liquids;
  double reach;
  double step;
  double max_speed;
  int cells[3];
  int walls;
  int walls_push;
  int free;
  int count;
  int materials;
  int dimensions;
  int first;
  int liquids;
  int implicit;
  int padding;
} Solids;

typedef struct {
  double travel;
  double omega2;
  double rate;
  int material;
  int touches_itself;
} Body;

double3 vector_at(global const double* vectors, int i) {
  return (double3)(vectors[3 * i], vectors[3 * i + 1], vectors[3 * i + 2]);
}

void store_vector(double3 v, global double* vectors, int i) {
  vectors[3 * i] = v.x;
  vectors[3 * i + 1] = v.y;
  vectors[3 * i + 2] = v.z;
}

double product(double3 a, double3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

double3 cross_product(double3 a, double3 b) {
  return (double3)(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

int cell_of_solid(const Solids* p, double coordinate, int axis) {
  const double cell = (coordinate - p->origin[axis]) * p->inverse_cell;
  const int last = p->cells[axis] - 1;
  // In this form, a NaN has cell 0.
  return cell > 0 ? cell < last ? (int)cell : last : 0;
}

double wrapped_solid(const Solids* p, double coordinate, int axis) {
  return wrapped(coordinate, p->origin[axis], p->period[axis]);
}

// The images of a world along an axis that may be within `radius` of a coordinate: the first and the
// last of -1, 0, 1.
INLINE int2 images_near(const Solids* p, double coordinate, double radius, int axis) {
  if (!(p->period[axis] > 0)) return 0;
  const double from_low = coordinate - p->origin[axis];
  const double margin = radius * (1 + 1e-6);  // above rounding errors
  return (int2)(p->period[axis] - from_low <= margin ? -1 : 0, from_low <= margin ? 1 : 0);
}

// The first and the last cell within `radius` of a coordinate.
INLINE int2 cells_of_solids(const Solids* p, double coordinate, double radius, int axis) {
  return (int2)(cell_of_solid(p, coordinate - radius, axis),
                cell_of_solid(p, coordinate + radius, axis));
}

// Runs BODY for each row of cells within `radius` of the place `at`, with the slots [begin, end). `shift`
// is the vector between periodic images. BODY adds it to vectors from the particles of these slots.
#define FOR_EACH_ROW_OF_SOLIDS(p, at, radius, begins, BODY)                    \
  {                                                                            \
    const int2 images_x = images_near(p, (at).x, radius, 0);                   \
    const int2 images_y = images_near(p, (at).y, radius, 1);                   \
    const int2 images_z = images_near(p, (at).z, radius, 2);                   \
    for (int image_z = images_z.x; image_z <= images_z.y; ++image_z) {         \
      for (int image_y = images_y.x; image_y <= images_y.y; ++image_y) {       \
        for (int image_x = images_x.x; image_x <= images_x.y; ++image_x) {     \
          const double3 shift =                                                \
              (double3)(image_x * (p)->period[0], image_y * (p)->period[1],    \
                        image_z * (p)->period[2]);                             \
          const int2 along_x = cells_of_solids(p, (at).x + shift.x, radius, 0); \
          const int2 along_y = cells_of_solids(p, (at).y + shift.y, radius, 1); \
          const int2 along_z = cells_of_solids(p, (at).z + shift.z, radius, 2); \
          const int low[3] = {along_x.x, along_y.x, along_z.x};                \
          const int high[3] = {along_x.y, along_y.y, along_z.y};               \
          FOR_EACH_ROW_IN(p, low, high, begins, BODY)                          \
        }                                                                      \
      }                                                                        \
    }                                                                          \
  }

// The positions in the order of cells are three columns, and a fourth one has the indices of bodies.
// After each column, a vector may follow.
#define SORTED_END 8

int sorted_stride(const Solids* p) {
  return p->count + SORTED_END;
}

double3 sorted_at(const Solids* p, global const double* sorted, int slot) {
  const int stride = sorted_stride(p);
  return (double3)(sorted[slot], sorted[stride + slot], sorted[2 * stride + slot]);
}

// Runs BODY for each `slot` in [begin, end) whose particle is closer than sqrt(square) to the place `at`,
// with the vector `shift` between periodic images. The body `untouched` has no such particles.
#if LANES > 1
// Bit l is set for such a slot block + l, with l < 8.
INLINE uint bits_near(const Solids* p, global const double* sorted, int block, int end, double3 at,
                      double3 shift, double square, double untouched) {
  const int stride = sorted_stride(p);
  global const double* row = sorted + block;
  const double8 x = at.x - vload8(0, row) + shift.x;
  const double8 y = at.y - vload8(0, row + stride) + shift.y;
  const double8 z = at.z - vload8(0, row + 2 * stride) + shift.z;
  const double8 body = vload8(0, row + 3 * stride);
  const int8 is_inside = (int8)(0, 1, 2, 3, 4, 5, 6, 7) < end - block;
  return byte_of(convert_char8(x * x + y * y + z * z < square && body != untouched) &
                 convert_char8(is_inside));
}
#define FOR_EACH_NEAR(p, sorted, begin, end, at, shift, square, untouched, BODY) \
  for (int block = begin; block < end; block += 8) {                           \
    uint near = bits_near(p, sorted, block, end, at, shift, square, untouched); \
    while (near != 0) {                                                        \
      const int slot = block + 31 - clz(near & -near);                         \
      near &= near - 1;                                                        \
      BODY                                                                     \
    }                                                                          \
  }
#else
bool is_near_solid(const Solids* p, global const double* sorted, int slot, double3 at,
                   double3 shift, double square, double untouched) {
  if (sorted[3 * sorted_stride(p) + slot] == untouched) return false;
  const double3 way = at - sorted_at(p, sorted, slot) + shift;
  return product(way, way) < square;
}
#define FOR_EACH_NEAR(p, sorted, begin, end, at, shift, square, untouched, BODY) \
  for (int slot = begin; slot < end; ++slot) {                                 \
    if (!is_near_solid(p, sorted, slot, at, shift, square, untouched)) continue;     \
    BODY                                                                       \
  }
#endif

// The position of a particle in the box of a periodic world.
double3 place_of_solid(const Solids* p, global const double* position, int i) {
  return (double3)(wrapped_solid(p, position[3 * i], 0), wrapped_solid(p, position[3 * i + 1], 1),
                   wrapped_solid(p, position[3 * i + 2], 2));
}

// Adds a particle to its cell.
void enter_solid(const Solids* p, int i, const double* x, global int* cell_of, global int* rank,
                 global int* cell_counts) {
  int c[3];
  for (int k = 0; k < 3; ++k) c[k] = cell_of_solid(p, wrapped_solid(p, x[k], k), k);
  const int cell = (c[2] * p->cells[1] + c[1]) * p->cells[0] + c[0];
  cell_of[i] = cell;
  rank[i] = atomic_inc(cell_counts + cell);
}

// The distance from a wall, negative outside the vat; see wall_distance().
double distance_from_wall(const Solids* p, int wall, double coordinate) {
  const int axis = wall / 2;
  const double x = coordinate - p->offset[axis];
  return wall % 2 == 0 ? x - p->wall_low[axis] : p->wall_high[axis] - x;
}

// Moves a particle beyond walls to their planes, and removes its outward velocity.
bool stop_at_walls(const Solids* p, double* x, double* v) {
  bool is_stopped = false;
  for (int wall = 0; wall < 6; ++wall) {
    const int axis = wall / 2;
    if (!((p->walls >> wall) & 1) || !(distance_from_wall(p, wall, x[axis]) < 0)) continue;
    is_stopped = true;
    const double speed = v[axis] - p->wall_velocity[axis];
    if (wall % 2 == 0 ? speed < 0 : speed > 0) v[axis] = p->wall_velocity[axis];
    x[axis] = wall % 2 == 0 ? p->plane_low[axis] : p->plane_high[axis];
  }
  return is_stopped;
}

// The square of the greatest valid speed in a step of p.step, see GuardBounds::travel.
double greatest_speed2_of(const Solids* p, global const Body* body) {
  const double speed = fmin(p->max_speed, body->travel / p->step);
  return speed * speed;
}

// Stops a particle at walls at the end of a step, and checks its state.
void check_solid(const Solids* p, double mobility, double greatest_speed2, double* x, double* v,
                 global int* status) {
  bool sound = is_within(p->domain_low, p->domain_high, greatest_speed2, x, v);
  if (mobility > 0 && stop_at_walls(p, x, v)) {
    atomic_inc(status + kStops);
    sound = sound && is_within(p->domain_low, p->domain_high, greatest_speed2, x, v);
  }
  if (!sound) atomic_or(status + kFault, 1);
}

// Ends a step: loads the particle, kicks it, stops it at walls, and checks its state.
void end_solid_step(const Solids* p, int i, global const double* position,
                    global const double* velocity, global const double* force, double mobility,
                    double greatest_speed2, double* x, double* v, global int* status) {
  for (int k = 0; k < 3; ++k) {
    x[k] = position[3 * i + k];
    v[k] = velocity[3 * i + k] + (p->closing * mobility) * force[3 * i + k];
  }
  if (p->closing > 0) check_solid(p, mobility, greatest_speed2, x, v, status);
}

// Ends a step, and begins the next one with a kick and a drift. The drift of implicit springs has
// preceded. Counts the particles of each cell.
// The velocities that forces depend on are kicked by the prediction.
kernel void move_solids(const Solids p, global double* position, global double* velocity,
                        global double* predicted, global const double* force,
                        global const double* mobility, global const int* body_of,
                        global const Body* bodies, global int* cell_of, global int* rank,
                        global int* cell_counts, global int* status) {
  const int i = get_global_id(0);
  if (i >= p.count) return;
  double x[3];
  double v[3];
  if (i < p.free) {
    const double mine = mobility[i];
    end_solid_step(&p, i, position, velocity, force, mine, greatest_speed2_of(&p, bodies + body_of[i]), x,
                   v, status);
    const double prediction = i < p.liquids ? p.prediction_of_liquids : p.prediction;
    for (int k = 0; k < 3; ++k) {
      v[k] += (p.opening * mine) * force[3 * i + k];
      if (i < p.implicit) x[k] += p.drift * v[k];
      position[3 * i + k] = x[k];
      velocity[3 * i + k] = v[k];
      predicted[3 * i + k] = v[k] + (prediction * mine) * force[3 * i + k];
    }
  } else {
    for (int k = 0; k < 3; ++k) x[k] = position[3 * i + k];
  }
  enter_solid(&p, i, x, cell_of, rank, cell_counts);
}

// Kicks by the forces over `dt`.
kernel void kick_solids(const int count, const double dt, global double* velocity,
                        global const double* force, global const double* mobility) {
  const int i = get_global_id(0);
  if (i >= count) return;
  for (int k = 0; k < 3; ++k) velocity[3 * i + k] += (dt * mobility[i]) * force[3 * i + k];
}

// Stops particles at walls at the end of a step, and checks their state.
kernel void check_solids(const Solids p, global double* position, global double* velocity,
                         global const double* mobility, global const int* body_of,
                         global const Body* bodies, global int* status) {
  const int i = get_global_id(0);
  if (i >= p.free) return;
  double x[3];
  double v[3];
  for (int k = 0; k < 3; ++k) {
    x[k] = position[3 * i + k];
    v[k] = velocity[3 * i + k];
  }
  check_solid(&p, mobility[i], greatest_speed2_of(&p, bodies + body_of[i]), x, v, status);
  for (int k = 0; k < 3; ++k) {
    position[3 * i + k] = x[k];
    velocity[3 * i + k] = v[k];
  }
}

// Ends the last step of a call.
kernel void finish_solids(const Solids p, global double* position, global double* velocity,
                          global const double* force, global const double* mobility,
                          global const int* body_of, global const Body* bodies,
                          global int* status) {
  const int i = get_global_id(0);
  if (i >= p.free) return;
  double x[3];
  double v[3];
  end_solid_step(&p, i, position, velocity, force, mobility[i], greatest_speed2_of(&p, bodies + body_of[i]),
                 x, v, status);
  for (int k = 0; k < 3; ++k) {
    position[3 * i + k] = x[k];
    velocity[3 * i + k] = v[k];
  }
}

// Copies the positions in the order of cells; see collect. In a periodic world, the copies are in its
// box.
kernel void collect_solids(const Solids p, global const int* cell_of, global const int* begins,
                           global const int* unsorted, global const double* position,
                           global const int* body_of, global int* order,
                           global double* sorted) {
  const int t = get_global_id(0);
  if (t >= p.count) return;
  const int i = unsorted[t];
  const int slot = slot_in_cell(i, cell_of, begins, unsorted);
  order[slot] = i;
  const double3 x = place_of_solid(&p, position, i);
  const int stride = sorted_stride(&p);
  sorted[slot] = x.x;
  sorted[stride + slot] = x.y;
  sorted[2 * stride + slot] = x.z;
  sorted[3 * stride + slot] = body_of[i];
}
