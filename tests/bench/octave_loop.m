% The closed loop of vehicle_model.py with GNU Octave's lsode, called from sample to sample. Prints the nominal run's rows as JSON.
% Run by scripts/bench.
%
% usage: octave-cli octave_loop.m MODEL.json GAINS.json SCENARIO.json SUBSTEPS
%   SUBSTEPS  RK4 steps per sample in awmr, which determine the chord at rest; lsode chooses its own steps
1;  % a script, not a function

function y = saturate(x, limit)
  y = max(-limit, min(limit, x));
end

function g = resistance(alpha, beta, rest_speed, speed)
  g = alpha * max(abs(speed), rest_speed)^(beta - 1) * speed;
end

function d = rates(x, p, left, right, command)
  one_plus_cos = 1 + cos(x(7));
  both = left + right;
  side = both * sin(x(7));
  moment = p.front_axle * side + p.half_track * (right - left) * one_plus_cos;
  d = [x(4) * cos(x(3)) - x(5) * sin(x(3));
       x(4) * sin(x(3)) + x(5) * cos(x(3));
       x(6);
       (both * one_plus_cos - resistance(p.surge_alpha, p.surge_beta, p.surge_rest, x(4))) / p.mass + x(6) * x(5);
       (side - p.sway_alpha * x(5)) / p.mass - x(6) * x(4);
       (moment - resistance(p.yaw_alpha, p.yaw_beta, p.yaw_rest, x(6))) / p.inertia;
       saturate((saturate(command, p.stop) - x(7)) / p.time_constant, p.fastest)];
end

function [h, lost] = steering_h(p, tau_speed, half_ratio)
  h = 0;
  lost = tau_speed <= 1e-6;
  if !lost
    limit = p.h_max * max(0, min(1, 16 * tau_speed));
    h = saturate(half_ratio / tau_speed, limit);
    lost = abs(half_ratio / tau_speed) > limit;
  end
end

function [left, right, angle] = allocated(p, tau_speed, tau_turn)
  speed = max(4 * p.force_min, min(4 * p.force_max, tau_speed));
  [h, lost] = steering_h(p, speed, tau_turn / (4 * p.front_axle));
  quarter = 0.25 + h^2;
  over_track = tau_turn / (2 * p.half_track);
  if lost
    over_track = (tau_turn - 2 * p.front_axle * h * speed) / p.half_track;
  end
  asked = [speed - over_track, speed + over_track] * quarter;
  made = max(p.force_min, min(p.force_max, asked));
  if !lost && any(made != asked)
    rest = 2 * quarter * tau_turn - p.half_track * (made(2) - made(1));
    h = steering_h(p, sum(made), rest / (2 * p.front_axle));
  end
  left = made(1);
  right = made(2);
  angle = saturate(2 * atan(2 * h), p.stop);
end

function [left, right, angle] = control(p, gains, goal, speed, x)
  sliding = gains.heading.lambda * (mod(goal - x(3) + pi, 2 * pi) - pi) - x(6);
  heading = saturate(gains.heading.mu / gains.heading.epsilon * sliding, gains.heading.mu);
  tau_turn = resistance(p.yaw_alpha, p.yaw_beta, 1e-300, x(6)) + p.inertia * (heading - gains.heading.lambda * x(6));
  faster = saturate(gains.speed.mu / gains.speed.epsilon * (speed - x(4)), gains.speed.mu);
  tau_speed = resistance(p.surge_alpha, p.surge_beta, 1e-300, x(4)) + p.mass * (faster - x(6) * x(5));
  [left, right, angle] = allocated(p, tau_speed, tau_turn);
end

function p = plant_of(model, step)
  v = model.vehicle;
  p = struct("surge_alpha", model.surge.alpha.value, "surge_beta", model.surge.beta.value, ...
             "yaw_alpha", model.yaw.alpha.value, "yaw_beta", model.yaw.beta.value, "sway_alpha", model.sway.alpha.value, ...
             "mass", model.mass_norm.value, "inertia", model.inertia_norm.value, ...
             "time_constant", model.steering.time_constant_s.value, "front_axle", v.front_axle_m, ...
             "half_track", v.half_track_m, "stop", v.steering.max_deg * pi / 180, ...
             "fastest", v.steering.max_rate_degps * pi / 180, "force_min", v.wheel_force.min, "force_max", v.wheel_force.max);
  p.h_max = 0.5 * tan(0.5 * p.stop);
  p.surge_rest = (p.surge_alpha * step / p.mass)^(1 / (1 - p.surge_beta));
  p.yaw_rest = (p.yaw_alpha * step / p.inertia)^(1 / (1 - p.yaw_beta));
end

words = argv();
files = cellfun(@(path) jsondecode(fileread(path)), words(1:3), "UniformOutput", false);
[model, gains, scenario] = files{:};
sample_time = model.vehicle.sample_time_s;
p = plant_of(model, sample_time / str2double(words{4}));
samples = round(scenario.duration_s / sample_time);
lsode_options("relative tolerance", 1e-6);
lsode_options("absolute tolerance", 1e-9);
x = zeros(7, 1);
rows = zeros(samples + 1, 7);
for sample = 1:samples
  steps = scenario.guidance.steps;
  goal = steps(find([steps.t_s] <= (sample - 1) * sample_time, 1, "last")).psi_deg * pi / 180;
  [left, right, angle] = control(p, gains, goal, scenario.speed_mps, x);
  x = lsode(@(x, t) rates(x, p, left, right, angle), x, [0, sample_time])(2, :)';
  rows(sample + 1, :) = x;
end
printf("{\"rows\": %s}\n", jsonencode(rows));
