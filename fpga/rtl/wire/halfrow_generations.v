// Which bank of tables rows use and under which generation, the shape of each, and the commit that waits for its frame.
`default_nettype none

module halfrow_generations #(
    parameter TABLE_BANKS = 2
) (
    input  wire        clk,
    input  wire        wipe,           // pulse: generation 0
    input  wire        forget,         // pulse: no commit waits
    input  wire        commit,         // pulse: the shadow bank is good
    input  wire [7:0]  new_generation, // 1 to 255 with `commit`
    input  wire [3:0]  new_shape,      // with `commit`: {k is 6, v} of fpga/DATAPATH.md
    input  wire        factor_written, // pulse: into the shadow bank, which holds no grid from then on
    input  wire [15:0] first_frame,
    input  wire        frame_start,    // pulse: row 0 of a frame is about to enter; what it uses shows a clock later
    input  wire [15:0] frame_number,
    output wire        known,          // the new generation is the active or the pending one
    output reg  [7:0]  generation,     // 0 for none
    output reg         active_bank,
    output wire        shadow_bank,    // the same one in a build with one bank
    output reg  [7:0]  shapes,         // {bank 1, bank 0}
    output reg         commit_pending,
    output reg  [15:0] commit_frame
);
    reg [7:0] pending_generation;

    assign known = (commit_pending && new_generation == pending_generation)
                || (new_generation != 8'd0 && new_generation == generation);
    assign shadow_bank = (TABLE_BANKS == 2) && !active_bank;

    wire begins = commit_pending && frame_start && frame_number == commit_frame;

    wire [3:0] shadow_shape = commit ? new_shape : 4'd0;
    always @(posedge clk)
        if (wipe)
            shapes <= 8'd0;
        else if (commit || factor_written)
            shapes <= shadow_bank ? {shadow_shape, shapes[3:0]} : {shapes[7:4], shadow_shape};

    always @(posedge clk) begin
        if (commit) begin
            pending_generation <= new_generation;
            commit_frame <= first_frame;
        end
        if (wipe) begin
            generation <= 8'd0;
            active_bank <= 1'b0;
        end else if (TABLE_BANKS == 1) begin
            if (commit) generation <= new_generation;
        end else if (begins) begin
            generation <= pending_generation;
            active_bank <= !active_bank;
        end
        commit_pending <= (TABLE_BANKS == 2) && !forget && (commit || (commit_pending && !begins));
    end
endmodule

`default_nettype wire
