// The transport velocity of a liquid that fills its world, see core/liquid/tait/transport.h.

typedef struct {
  float gradient;  // gradient of the kernel times volume / (weight * slope * x)
  float strength;  // transport velocity / sum of weight * slope * x
} Transport;

// Moves the particles by their transport velocity.
kernel void drift_with_transport(const int count, const double dt, global const float4* transport,
                                 global double* position) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const float4 w = transport[i];
  const double by[3] = {w.x, w.y, w.z};
  for (int k = 0; k < 3; ++k) position[3 * i + k] += dt * by[k];
}

// Sets the transport velocities, in the order of particles and in that of cells. Those of solids are 0.
kernel void find_transport(const Parameters p, const Transport t, global const int* begins,
                           global const int* order, global const int4* sorted_place,
                           global const int* counts, global const uint* lists,
                           global float4* sorted_transport, global float4* transport) {
  const int slot = get_global_id(0);
  if (slot >= p.count + p.solids) return;
  const int4 own = sorted_place[slot];
  sorted_transport[slot] = 0;
  if (is_solid(own)) return;
  const int n[3] = {own.x, own.y, own.z};
  float3 sum = 0;
  FOR_EACH_NEIGHBOUR(&p, slot, n, begins, counts, lists, {
    const int4 source = sorted_place[j];
    const float3 x = way_from(&p, code, n, source);
    const float square = square_of(x);
    if (!(square < 1)) continue;
    sum += weight_of(source) * kernel_slope(sqrt(square)) * x;
  })
  const float4 w = (float4)(t.strength * sum, 0);
  sorted_transport[slot] = w;
  transport[order[slot]] = w;
}

// Adds the momentum transport by these velocities.
kernel void add_transport_forces(const Parameters p, const Transport t, global const int* begins,
                                 global const int* order, global const int4* sorted_place,
                                 global const float4* sorted_motion, global const int* counts,
                                 global const uint* lists, global const float4* sorted_transport,
                                 global float4* acceleration) {
  const int slot = get_global_id(0);
  if (slot >= p.count + p.solids) return;
  const int4 own = sorted_place[slot];
  if (is_solid(own)) return;
  const int n[3] = {own.x, own.y, own.z};
  const float3 u = sorted_motion[slot].xyz;
  const float3 w = sorted_transport[slot].xyz;
  float3 sum = 0;
  FOR_EACH_NEIGHBOUR(&p, slot, n, begins, counts, lists, {
    const int4 source = sorted_place[j];
    const float3 x = way_from(&p, code, n, source);
    const float square = square_of(x);
    if (!(square < 1)) continue;
    const float3 gradient = weight_of(source) * kernel_slope(sqrt(square)) * x;
    sum += dot_of(w, gradient) * u;
    const float3 its = turned(&p, code, sorted_transport[j].xyz);
    sum += dot_of(its, gradient) * turned(&p, code, sorted_motion[j].xyz);
  })
  acceleration[order[slot]] += (float4)(t.gradient * sum, 0);
}
