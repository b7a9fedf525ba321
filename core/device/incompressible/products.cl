// The factors of the matrix of a solve, as sums over the neighbours of a particle; see
// core/liquid/incompressible/pressure_response.h.
//
// For a liquid particle, a solid particle counts as a mirror image of it with twice the weight.

// D of the motions, divided by rate_factor.
float rate_of(const Parameters* p, int slot, global const int* begins,
              global const int4* sorted_place, global const int* counts, global const uint* lists,
              global const float4* motions) {
  const int4 own = sorted_place[slot];
  const int n[3] = {own.x, own.y, own.z};
  const float3 mine = motions[slot].xyz;
  float sum = 0;
  FOR_EACH_NEIGHBOUR(p, slot, n, begins, counts, lists, {
    const int4 other = sorted_place[j];
    const float3 x = way_from(p, code, n, other);
    const float square = square_of(x);
    if (!(square < 1)) continue;
    const float3 v = mine - turned(p, code, motions[j].xyz);
    const float weight = is_solid(other) ? 2 * weight_of(other) : weight_of(other);
    sum += weight * kernel_slope(sqrt(square)) * (v.x * x.x + v.y * x.y + v.z * x.z);
  })
  return sum;
}

#if LANES > 1
// Finds the results of rate_of() for LANES slots from `first` on, except of solids.
void find_rates(const Parameters* p, int first, global const int* begins,
                global const int4* sorted_place, global const int* counts,
                global const int* plain_counts, global const uint* lists,
                global const float4* motions, float* rates) {
  global const float4* places = (global const float4*)sorted_place;
  const Columns own = columns_at(places, first);
  const Columns mine = columns_at(motions, first);
  float16 sum = 0;
  FOR_EACH_LISTED(p, first, counts, plain_counts, lists, {
    const Columns source = gather(places, offsets);
    Columns its = gather(motions, offsets);
    const Ways x = ways_from(p, listed, has_images, own, source);
    if (has_images) {
      const Mirrors m = mirrors_of(listed);
      its.x = select(its.x, -its.x, reverse(p, &m, 0));
      its.y = select(its.y, -its.y, reverse(p, &m, 1));
      its.z = select(its.z, -its.z, reverse(p, &m, 2));
    }
    const float16 weight = select(source.w, -2 * source.w, source.w < 0);
    const float16 rate =
        (mine.x - its.x) * x.x + (mine.y - its.y) * x.y + (mine.z - its.z) * x.z;
    sum += select(0.0f, weight * kernel_slopes(sqrt(x.square)) * rate, is_listed);
  })
  vstore16(sum, 0, rates);
  for (int lane = 0; lane < LANES && first + lane < p->count + p->solids; ++lane) {
    if (counts[first + lane] <= p->list_length || is_solid(sorted_place[first + lane])) continue;
    rates[lane] = rate_of(p, first + lane, begins, sorted_place, counts, lists, motions);
  }
}
#else
void find_rates(const Parameters* p, int first, global const int* begins,
                global const int4* sorted_place, global const int* counts,
                global const int* plain_counts, global const uint* lists,
                global const float4* motions, float* rates) {
  if (is_solid(sorted_place[first])) return;
  rates[0] = rate_of(p, first, begins, sorted_place, counts, lists, motions);
}
#endif

// A charge of a solve. Vectors of charges are gathered from vectors.
#if LANES > 1
typedef float4 Charge;
#define CHARGE(value) ((float4)(value, 0, 0, 0))
#define VALUE_OF(charge) charge.x
#else
typedef float Charge;
#define CHARGE(value) (value)
#define VALUE_OF(charge) charge
#endif

// The accelerations by the charges, divided by -acceleration_factor. The charge of a solid is 0, so that
// it receives the sum over the charges of the liquid.
float3 push_of(const Parameters* p, int slot, global const int* begins,
               global const int4* sorted_place, global const int* counts,
               global const uint* lists, global const Charge* charge) {
  const int4 own = sorted_place[slot];
  const int n[3] = {own.x, own.y, own.z};
  const float mine = VALUE_OF(charge[slot]);
  float3 sum = 0;
  FOR_EACH_NEIGHBOUR(p, slot, n, begins, counts, lists, {
    const int4 other = sorted_place[j];
    const float3 x = way_from(p, code, n, other);
    const float square = square_of(x);
    if (!(square < 1)) continue;
    const float both = is_solid(other) ? 2 * mine : mine + VALUE_OF(charge[j]);
    sum += both * (weight_of(other) * kernel_slope(sqrt(square))) * x;
  })
  return sum;
}

#if LANES > 1
// Finds the results of push_of() for LANES slots from `first` on, those of solids only if they move.
void find_pushes(const Parameters* p, int solids_move, int first, global const int* begins,
                 global const int4* sorted_place, global const int* counts,
                 global const int* plain_counts, global const uint* lists,
                 global const Charge* charge, float3* pushes) {
  global const float4* places = (global const float4*)sorted_place;
  const Columns own = columns_at(places, first);
  const float16 mine = columns_at(charge, first).x;
  float16 x = 0;
  float16 y = 0;
  float16 z = 0;
  FOR_EACH_LISTED(p, first, counts, plain_counts, lists, {
    const Columns source = gather(places, offsets);
    const float16 its = gather(charge, offsets).x;
    const Ways w = ways_from(p, listed, has_images, own, source);
    const float16 both = select(mine + its, 2 * mine, source.w < 0);
    const float16 share =
        select(0.0f, both * (fabs(source.w) * kernel_slopes(sqrt(w.square))), is_listed);
    x += share * w.x;
    y += share * w.y;
    z += share * w.z;
  })
  float all[3][LANES];
  vstore16(x, 0, all[0]);
  vstore16(y, 0, all[1]);
  vstore16(z, 0, all[2]);
  for (int lane = 0; lane < LANES && first + lane < p->count + p->solids; ++lane) {
    pushes[lane] = (float3)(all[0][lane], all[1][lane], all[2][lane]);
    if (counts[first + lane] <= p->list_length) continue;
    if (is_solid(sorted_place[first + lane]) && !solids_move) continue;
    pushes[lane] = push_of(p, first + lane, begins, sorted_place, counts, lists, charge);
  }
}
#else
void find_pushes(const Parameters* p, int solids_move, int first, global const int* begins,
                 global const int4* sorted_place, global const int* counts,
                 global const int* plain_counts, global const uint* lists,
                 global const Charge* charge, float3* pushes) {
  if (is_solid(sorted_place[first]) && !solids_move) return;
  pushes[0] = push_of(p, first, begins, sorted_place, counts, lists, charge);
}
#endif
