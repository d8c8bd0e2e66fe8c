#!/usr/bin/env bash
# Plants one fault after the other in a copy of the workspace and runs the test that must turn red.
#
#   crates/transport/tests/plant_faults.sh [name...]
#   crates/transport/tests/plant_faults.sh --stale
#
# The second only names the faults that are STALE, within a second. Without names: all faults. Prints CAUGHT or MISSED for each, STALE where the line to be changed is no longer
# there, BROKEN where the changed source does not compile; exits 1 unless all are CAUGHT. The copy and its build
# are kept in $FAULTS_DIR (default: /tmp/caustica-faults), so that a second run compiles little.
set -u
root=$(cd "$(dirname "$0")/../../.." && pwd)
dir=${FAULTS_DIR:-/tmp/caustica-faults}

# name | crate | sed expression | test
identity='-p caustica-transport --test path_identity'
strategies='-p caustica-transport --test strategies'
rows='-p caustica-transport --test known_failures'
faults=$(cat <<TABLE
adjoint|transport|s/let ratio = if is_planted(Fault::Adjoint) { 1.0 }.*/let ratio = 1.0;/|$identity
adjoint-sampled|transport|s/Walk::FromLight => s.value \* (cos.abs() \/ self.cos(self.prev)),/Walk::FromLight => s.value,/|$identity
swapped-pdfs|transport|s/forward: e.to_light_pdf, reverse: e.to_camera_pdf }/forward: e.to_camera_pdf, reverse: e.to_light_pdf }/|$identity
emission-for-next-event|transport|s/h.of(share \* lights.towards_pdf(from.receiver(), &end.lamp).0 \/ end.forward)/h.of(share * pdf.point.0 \/ end.forward)/|$identity
paths-of-a-pass|transport|s/sums.total(from_camera \/ paths, /sums.total(from_camera, /|$identity
crop-for-full|transport|s/light_paths: window.width as f32 \* window.height as f32,/light_paths: scene.film.width as f32 * scene.film.height as f32,/|$rows crop_window
eta-squared|scene|s/Walk::FromCamera => share \* eta \* eta,/Walk::FromCamera => share,/|$identity
dirac-reverse|scene|s/reverse_pdf: SolidAnglePdf(share \* spread),/reverse_pdf: SolidAnglePdf(share),/|$identity
lamp-cosine|transport|s/let to_lamp = edge.jacobian(found.point.cos(found.direction));/let to_lamp = edge.falloff;/|$strategies every_strategy_under_emission
disk-density|scene|s/FRAC_1_PI \/ (self.radius \* self.radius))/FRAC_1_PI \/ self.radius)/|$rows irradiance
delta-is-hittable|transport|s/let from_camera = if delta { 0.0 } else { scatter.forward.0 \* to_lamp };/let from_camera = scatter.forward.0 * to_lamp; let _ = delta;/|$strategies every_strategy_under_a_point_light
lamp-choice|scene|s/emission.pdf.point = emission.pdf.point \* mass;/let _ = mass;/|$strategies every_strategy_under_both
lens-density|scene|s/SolidAnglePdf(1.0 \/ (pixel \* pixel \* cos \* cos \* cos))/SolidAnglePdf(1.0 \/ (pixel * pixel * cos * cos))/|$rows thin_lens
roulette|transport|s/flight.throughput \*= 1.0 \/ survival;//|$rows roulette
filter-ignored|testkit|s/let weight = filter.eval(x as f32 + 0.5 - film.x, y as f32 + 0.5 - film.y);/let weight = 1.0;/|$rows pixel_filters
filter-normalisation|math|s/Shape::Box { height: 0.5 \/ radius }/Shape::Box { height: 1.0 }/|$rows pixel_filters
specular-joined|transport|s/let recent = if step.delta { 0.0 } else { self.recent };/let recent = self.recent;/|$identity
infinity-jacobian|transport|s/None => Edge::INFINITE,/None => Edge::finite(4.0),/|$identity
mirrored-winding|scene|s/let mut outward = if mirrored { -normal } else { normal };/let mut outward = normal; let _ = mirrored;/|$rows mirrored_transforms
candidates-unpaid|transport|s/let value = c.value \* (1.0 \/ survival);/let value = c.value;/|-p caustica-transport --test candidates
stratum-shared|math|s/key: mix64(of_tile.wrapping_add(u64::from(walk) << 16)),/key: of_tile,/|-p caustica-transport --test samplers
aimed-unshared|transport|s/let density = scatter.forward.0 + self.aimed_rays.*/let density = scatter.forward.0;/|$identity
aimed-too-often|transport|s/junction, value \* share);/junction, value); let _ = share;/|$identity
joins-uncounted|transport|s/step.joins \* inverse/inverse/|$identity
joins-not-shared|transport|s/(edge.falloff \/ self.joins)/edge.falloff/|$identity
joins-of-one-side|transport|s/y.sums.total(junction.light.0 \/ self.joins,/y.sums.total(junction.light.0,/|$identity
pyramid-remainder|render|s/if i == last { left } else/if false { left } else/|-p caustica-render --test pyramid
seed-ignored|transport|s/seed: self.settings.seed,/seed: 0,/|$rows seeds
TABLE
)

failed=0
if [ "${1:-}" = --stale ]; then
    while IFS='|' read -r name crate change _; do
        sources() { find "$root/crates/$crate/src" -name '*.rs' -exec cat {} + 2>/dev/null; }
        if cmp -s <(sources) <(sources | sed "$change"); then
            echo "STALE: $name"
            failed=1
        fi
    done <<<"$faults"
    exit $failed
fi

rm -rf "$dir/tree"
mkdir -p "$dir/tree"
# Without their times: what an earlier run built with a fault in it must not pass for fresh.
for part in Cargo.toml Cargo.lock crates scenes; do
    [ -e "$root/$part" ] && cp -R "$root/$part" "$dir/tree/"
done
export CARGO_TARGET_DIR="$dir/target" RUST_BACKTRACE=0

# What is red without a fault shows nothing.
while read -r test; do
    if [ $# -eq 0 ] && ! (cd "$dir/tree" && cargo test -q $test) >"$dir/log" 2>&1 </dev/null; then
        echo "RED without a fault: $test"
        failed=1
    fi
done < <(cut -d'|' -f4 <<<"$faults" | sort -u)
while IFS='|' read -r name crate change test; do
    if [ $# -gt 0 ] && [[ " $* " != *" $name "* ]]; then continue; fi
    # The line may move from file to file of its crate.
    touched=()
    while read -r path; do
        sed "$change" "$path" >"$dir/changed"
        if ! cmp -s "$path" "$dir/changed"; then
            cp "$path" "$dir/whole.${#touched[@]}"
            cp "$dir/changed" "$path"
            touched+=("$path")
        fi
    done < <(find "$dir/tree/crates/$crate/src" -name '*.rs')
    if [ ${#touched[@]} -eq 0 ]; then
        verdict=STALE
    elif ! (cd "$dir/tree" && cargo test -q $test --no-run) >"$dir/log" 2>&1 </dev/null; then
        verdict=BROKEN
    elif (cd "$dir/tree" && timeout 300 cargo test -q $test) >"$dir/log" 2>&1 </dev/null; then
        verdict=MISSED
    else
        verdict=CAUGHT
    fi
    for i in "${!touched[@]}"; do cp "$dir/whole.$i" "${touched[i]}"; done
    [ $verdict = CAUGHT ] || failed=1
    printf '%-24s %-7s %-10s %s\n' "$name" $verdict "$crate" "${test#-p caustica-transport --test }"
done <<<"$faults"
exit $failed
