// Signatures of drawn rows, close behind each other or with clocks between their samples, against a register that takes one
// bit a time. A row that is too short counts as it is; a frame is the CRC-32 of its rows' signatures. What came in front of a
// row that begins anew counts for nothing.
`default_nettype none

module halfrow_signer_bench;
    reg clk = 0;
    always #5 clk = !clk;

    reg         rst = 1, anew = 0, valid = 0, last = 0, next_frame = 0;
    reg  [11:0] sample = 0;
    wire        signed_all;
    wire [31:0] row_signature, signature;

    halfrow_signer signer (
        .clk(clk), .rst(rst), .anew(anew), .valid(valid), .last(last), .sample(sample), .next_frame(next_frame),
        .signed_all(signed_all), .row_signature(row_signature), .signature(signature));

    reg     [31:0] row_crc, frame_crc;
    integer        frame, row, column, width, i, seed = 1, faults = 0, gaps;

    function [31:0] behind(input [31:0] crc, input one);
        behind = {1'b0, crc[31:1]} ^ (crc[0] ^ one ? 32'hEDB88320 : 32'd0);
    endfunction

    task give_row(input integer samples);
        begin
            row_crc = 32'hFFFFFFFF;
            for (column = 0; column < samples; column = column + 1) begin
                valid = 1;
                last = column == samples - 1;
                sample = $random(seed);
                for (i = 0; i < 16; i = i + 1) row_crc = behind(row_crc, i < 12 ? sample[i] : 1'b0);
                @(negedge clk);
                valid = 0;
                last = $random(seed); // without an output it means nothing
                sample = $random(seed);
                if (gaps) repeat ($random(seed) & 1) @(negedge clk);
            end
            for (i = 0; i < 32; i = i + 1) frame_crc = behind(frame_crc, !row_crc[i]);
            if (!gaps && row_signature !== ~row_crc) begin
                faults = faults + 1;
                $display("FAIL row: %h, expected %h", row_signature, ~row_crc);
            end
        end
    endtask

    task look;
        begin
            if (signed_all) faults = faults + 1; // the last row is not in it yet
            repeat (33) @(negedge clk);
            if (!signed_all || signature !== ~frame_crc) begin
                faults = faults + 1;
                $display("FAIL frame %0d: %h, expected %h", frame, signature, ~frame_crc);
            end
            next_frame = 1;
            @(negedge clk) next_frame = 0;
        end
    endtask

    initial begin
        anew = 1;
        @(negedge clk) {anew, rst} = 2'b00;
        for (frame = 0; frame < 40; frame = frame + 1) begin
            gaps = frame & 1;
            frame_crc = 32'hFFFFFFFF;
            for (row = $random(seed) & 3; row >= 0; row = row - 1) give_row(64 + ($random(seed) & 15));
            look;
        end
        if (faults == 0) $display("PASS 40 frames of drawn rows");
        give_row(64);
        repeat (5) begin // and the start of a row
            valid = 1;
            @(negedge clk) valid = 0;
        end
        {anew, rst} = 2'b11;
        @(negedge clk) {anew, rst} = 2'b00;
        frame_crc = 32'hFFFFFFFF;
        give_row(64);
        look;
        if (faults == 0) $display("PASS nothing is left of a frame that was dropped");
        if (faults != 0) $display("FAIL %0d faults", faults);
        $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
