/* A car with an engine on the rear axle: it gathers speed, turns left and brakes.
 * cc car.c $(pkg-config --cflags --libs taut) && ./a.out */
#include <stdio.h>
#include <stdlib.h>
#include <taut/taut.h>

static void check(taut_result result) {
    if (result == TAUT_OK) return;
    fprintf(stderr, "%s\n", taut_last_error());
    exit(1);
}

int main(void) {
    taut_world world;
    taut_world_def world_def;
    taut_world_def_init(&world_def);
    check(taut_world_create(&world_def, &world));

    taut_plane_def plane;
    taut_plane_def_init(&plane);
    taut_body_def body;
    taut_body_def_init(&body);
    body.kind = TAUT_BODY_STATIC;
    body.material.friction = 1;
    check(taut_world_add_plane(world, &plane, &body.shape));
    taut_body ground;
    check(taut_world_add_body(world, &body, &ground));

    taut_box_def box;
    taut_box_def_init(&box);
    box.half_extents = (taut_vec3){2, 0.25f, 0.8f}; /* x is forwards */
    taut_body_def_init(&body);
    body.mass = 1200, body.position.y = 0.8;
    check(taut_world_add_box(world, &box, &body.shape));
    taut_body chassis;
    check(taut_world_add_body(world, &body, &chassis));

    taut_wheel_def wheels[4];
    for (int i = 0; i < 4; ++i) {
        taut_wheel_def_init(&wheels[i]);
        wheels[i].position = (taut_vec3){i < 2 ? 1.3f : -1.3f, -0.2f, i % 2 ? 0.75f : -0.75f};
        if (i < 2)
            wheels[i].steering = 0.6f;
        else
            wheels[i].drive = 1, wheels[i].handbrake = 3000;
    }
    const taut_engine_point torque[] = {{0, 200}, {300, 250}, {600, 180}}; /* rad/s, N m */
    const float gears[] = {13, 8, 5.5f, 4, 3.2f};                          /* with the axle's */
    taut_vehicle_def def;
    taut_vehicle_def_init(&def);
    def.chassis = chassis;
    def.wheels = wheels, def.wheel_count = 4;
    def.torque = torque, def.torque_count = 3;
    def.gears = gears, def.gear_count = 5;
    taut_vehicle car;
    taut_vehicle_init(&car);

    taut_vehicle_input input;
    taut_vehicle_input_init(&input);
    for (int step = 0; step < 900; ++step) {
        float time = (float)step * world_def.time_step;
        input.throttle = time < 8 ? 0.8f : 0;
        input.steering = time > 5 && time < 8 ? 0.1f : 0;
        input.brake = time > 10 ? 1 : 0;
        check(taut_vehicle_drive(world, &def, &input, world_def.time_step, &car));
        check(taut_world_step(world));
        if (step % 60 != 59) continue;
        taut_pose pose;
        check(taut_body_get_pose(chassis, &pose));
        printf("%2d s: at %6.1f, %6.1f, %5.1f m/s, gear %d at %3.0f rad/s\n", step / 60 + 1, pose.position.x,
               pose.position.z, car.forward_speed, (int)car.gear, car.engine_speed);
    }
    check(taut_world_destroy(world));
    return car.forward_speed < 0.1f ? 0 : 1;
}
